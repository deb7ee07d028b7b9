"""Parameters of the motion: field, movers, gate, filter, looks over the shoulder, body."""

from dataclasses import dataclass
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Lt

from navigation.parameters.bounds import Angle, Count, NonNegative, Positive, Rings, Share


@dataclass(frozen=True)
class UnivectorParameters:
    """Univector field (7)-(10)."""

    s_robot: Positive = 0.12
    """Radius of the robot [m]."""
    margin: NonNegative = 0.03
    """Margin added to the robot's radius in S_r [m]."""
    omega_soe: NonNegative = 1.0
    """Weight of speed and uncertainty in (7) [1]."""
    eta_vo: NonNegative = 0.5
    """Growth of the extended radius with the obstacle's speed [s]."""
    eta_imp: NonNegative = 0.05
    """Growth of the extended radius with the partial evaluations [m]."""
    d_con: Positive = 0.80
    """Distance within which the field bends towards the arrival heading [m]."""
    arrival: Literal["hard", "ramped", "nposture"] = "ramped"
    """(8): switched at d_con as printed, ramped in, or Kim's posture field."""
    k_alpha: Positive = 1.0
    """Arrival gain on the bearing of the destination [1]."""
    k_beta: Annotated[float, Lt(0.0)] = -0.6
    """Arrival gain on the heading still to turn [1]."""
    arrival_clamp: Positive = 1.3
    """Largest deviation of the ramped field from the destination [rad]."""
    arrival_ramp: Positive = 0.5
    """Width of the ramp, share of d_con [1]."""
    side_set: Positive = 2.304
    """|beta| beyond which the ramped arrival remembers the side it circles on [rad]."""
    side_clear: Positive = 1.798
    """|beta| below which it forgets that side [rad]."""
    posture_gain: Positive = 8.0
    """Gain of Kim's posture field [1]."""
    posture_offset: Positive = 0.25
    """Distance of its reference point beyond the destination [m]."""
    holonomic_distance: NonNegative = 0.45
    """Distance from the goal within which the body turns to the goal's heading [m]."""
    slow_distance: Positive = 0.30
    """Distance from the goal within which k_rho falls [m]."""
    slow_fraction: Share = 0.2
    """k_rho at the goal [1]."""
    d_e: Positive = 0.20
    """Radius offset of the spiral (9) [m]."""
    d_b: Positive = 0.25
    """Width of the outer band of (9) [m]."""
    k_r: Positive = 0.30
    """Curvature of the outer spiral (9) [m]."""
    inside: Literal["zero", "outward"] = "outward"
    """Field inside the extended radius: none as printed, or straight outward."""
    blend: Literal["weights", "distance"] = "distance"
    """(10): fixed weights as printed, or weights by distance."""
    w_muf: NonNegative = 0.75
    """Weight of move-to-goal for fixed weights [1]."""
    w_auf: NonNegative = 0.25
    """Weight of avoid-obstacle for fixed weights [1]."""
    grouping: bool = False
    """Whether obstacles with gaps too narrow for the robot are passed on one side."""
    side_memory: bool = False
    """Whether the side on which an obstacle is passed is kept while it is near."""
    goal_fraction: Share = 0.6
    """Share of the room between a destination and an obstacle left to its radius [1]."""
    min_goal_gap: Positive = 0.02
    """Least such room [m]."""
    min_goal_offset: Positive = 0.03
    """Least radius offset beside a destination [m]."""
    virtual_weight: NonNegative = 1.5
    """Weight of dynamic virtual obstacles in the blend by distance [1]."""
    memory: NonNegative = 1.0
    """Time unseen after which what may move leaves the field to the filter [s]."""


@dataclass(frozen=True)
class MovingObstacleParameters:
    """Dynamic virtual obstacle (11) and velocity modification."""

    virtual_obstacle: Literal["off", "printed", "uncapped"] = "uncapped"
    """(11) as printed, uncapped with a remembered side, or not at all."""
    xi: Annotated[float, Gt(0.0), Lt(1.0)] = 0.6
    """Convexity of the dynamic virtual obstacle [1]."""
    omega_dist: Positive = 12.0
    """Length of the virtual path of the printed form [1]."""
    path_time: Positive = 6.0
    """Length of the virtual path of the own form, per relative speed [s]."""
    side_switch: NonNegative = 0.05
    """Distance from a mover's path within which the destination decides the side [m]."""
    side_hold: NonNegative = 0.08
    """Distance beyond a mover's path at which the own form changes its side [m]."""
    side_aligned: Share = 0.2
    """Sine of the angle between path and destination up to which that decides nothing [1]."""
    min_speed: Positive = 0.015
    """Speed below which an obstacle has no path [m/s]."""
    velocity_modification: Literal["off", "closed", "sampled"] = "sampled"
    """Free speeds from the quadratic, from samples, or not at all."""
    radius: Literal["extended", "physical"] = "physical"
    """Radius velocity modification avoids: S_oe, or the bodies and a margin."""
    margin: NonNegative = 0.05
    """That margin [m]."""
    horizon: Positive = 6.0
    """Contacts later than this are ignored [s]."""
    wait_in_band: bool = True
    """Whether a robot in a mover's way may brake, which puts the contact off at best."""
    samples: Annotated[int, Ge(2)] = 21
    """Number of sampled speeds [1]."""
    acceleration_time: Positive = 0.8
    """Time over which the sampled form may accelerate [s]."""


@dataclass(frozen=True)
class UnseenGroundParameters:
    """Slow down before ground that was never seen."""

    enabled: bool = True
    """Whether the gate is used."""
    confidence: Share = 0.3
    """Confidence below which the ground counts as unseen [1]."""
    near: Positive = 0.36
    """Nearest ground asked for; a look at obstacles, 20 deg down, shows none nearer [m]."""
    far: Positive = 0.60
    """Farthest ground asked for [m]."""
    half_width: NonNegative = 0.10
    """Half width of the ground asked for [m]."""
    rows: Annotated[int, Ge(2)] = 4
    """Rows of points from the nearest to the farthest [1]."""
    speed: NonNegative = 0.03
    """Largest speed towards unseen ground [m/s]."""


@dataclass(frozen=True)
class SafetyFilterParameters:
    """Time-to-contact filter over rolled-out footsteps."""

    enabled: bool = True
    """Whether the filter is used."""
    headings: Count = 24
    """Number of candidate directions [1]."""
    speeds: Count = 6
    """Number of candidate speeds per direction [1]."""
    steps: Annotated[int, Ge(0)] = 4
    """Footsteps rolled out with the body's real motion before the straight path [1]."""
    turn_change: Positive = 0.4
    """Largest change of the turn rate from footstep to footstep [rad/s]."""
    static_horizon: Positive = 2.0
    """Time to contact below which static obstacles count [s]."""
    moving_horizon: Positive = 6.0
    """Time to contact below which movers count [s]."""
    bend_time: Positive = 2.0
    """Time over which a mover's bend is averaged: it counts as going along that chord [s]."""
    reversal_horizon: Positive = 2.5
    """Time to contact below which the reversal of a mover counts [s]."""
    urgent_time: Positive = 1.5
    """Time to contact below which a contact is urgent [s]."""
    urgent_weight: NonNegative = 20.0
    """Penalty of an urgent contact [1]."""
    weight: NonNegative = 6.0
    """Penalty of any other contact [1]."""
    change_weight: NonNegative = 0.15
    """Penalty of a change of velocity [1]."""
    particle_weight: NonNegative = 2.0
    """Weight of a lost mover's particles together [1]."""
    reversal_weight: NonNegative = 0.12
    """Weight of the reversal of a visible mover [1]."""
    reachable: bool = False
    """Whether an unseen mover also counts as all it can have reached from its last place."""
    reachable_radius: NonNegative = 0.4
    """Largest growth of that disc [m]."""
    reachable_delay: NonNegative = 0.3
    """Time unseen before it grows [s]."""
    reachable_age: Positive = 6.0
    """Time unseen after which it is dropped [s]."""
    margin: NonNegative = 0.045
    """Distance kept from the bodies of obstacles: a stepping foot reaches out so far beyond
    `univector.s_robot` [m]."""
    max_sigma: NonNegative = 0.06
    """Largest part of a mover's position uncertainty added to that [m]."""
    inside_weight: NonNegative = 10.0
    """Extra penalty of a contact with a disc the robot is already in [1]."""
    inside_depth: NonNegative = 40.0
    """Extra penalty for the depth in it, as a share of its radius [1]."""
    inside_closing: NonNegative = 100.0
    """Extra penalty per closing speed [s/m]."""


@dataclass(frozen=True)
class LandmarkParameters:
    """Landmarks of the map as obstacles."""

    attention_range: NonNegative = 1.0
    """Distance within which one counts; farther off only `mppi` heeds what stands [m]."""
    sigma: Positive = 0.005
    """Standard deviation of place and velocity, that of a static track known for long [m, m/s]."""


@dataclass(frozen=True)
class WaypointSearchParameters:
    """Way points round still obstacles that block the straight way."""

    enabled: bool = False
    """Whether the search is used."""
    cell: Positive = 0.10
    """Side of a cell [m]."""
    reach: Positive = 1.2
    """Largest distance of the way point [m]."""
    around: Positive = 1.0
    """How far the search goes beyond robot and destination [m]."""


@dataclass(frozen=True)
class RearCheckParameters:
    """Looks over the shoulder: the body turns aside so that the gaze reaches what is behind."""

    enabled: bool = True
    """Whether the body turns aside."""
    near_angle: Angle = 0.4
    """Angle of the body to its way for ground just out of the gaze's reach [rad]."""
    far_angle: Angle = 0.95
    """Angle of the body to its way for ground right behind [rad]."""
    far_weight: NonNegative = 0.77
    """Weight of the urgency of ground right behind, for which the robot slows down [1]."""
    rings: Rings = (0.40, 0.65, 0.90, 1.20)
    """Distances of the ground looked at; a lost mover farther off than all does not count [m]."""
    rays: Annotated[int, Ge(2)] = 4
    """Directions of it on either side, as many beside as right behind [1]."""
    mover_speed: NonNegative = 1.1
    """Feared speed of what was not seen, share of the robot's [1]."""
    start_urgency: Positive = 0.7
    """Age of ground over the time to contact from which the body turns aside [1]."""
    stop_urgency: NonNegative = 0.3
    """The same below which it turns back [1]."""
    max_turn_time: Positive = 2.5
    """Longest time turned aside [s]."""
    retry_delay: NonNegative = 2.0
    """Time until the next try, if nothing was seen by then [s]."""
    clearance: NonNegative = 0.25
    """Gap to what may move within which the robot leaves first and looks round later [m]."""
    min_approach: Positive = 0.02
    """Least speed at which something unseen is taken to come nearer [m/s]."""
    min_time: Positive = 0.4
    """Shortest time to contact counted [s]."""
    max_age: Positive = 8.0
    """Age of ground from which nothing grows worse [s]."""
    max_urgency: Positive = 2.0
    """Largest urgency of a point on the ground [1]."""


@dataclass(frozen=True)
class VelocityMappingParameters:
    """From a direction and a speed to a body velocity."""

    turn_gain: Positive = 1.5
    """Turn rate per heading error [1/s]."""
    turn_first_angle: NonNegative = 0.5
    """Heading error below which a fast path is walked without turning first [rad]."""
    sidestep_ratio: NonNegative = 1.2
    """Speed up to which no path needs a turn first, share of the largest sideways [1]."""
    lost_turn_rate: NonNegative = 0.5
    """Turn rate of a lost robot, whose head alone does not reach all around [rad/s]."""
