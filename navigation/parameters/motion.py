"""Parameters of the motion: univector field, moving obstacles, safety filter, velocity mapping.

Public keys of a scenario have bounds and a docstring; all other fields are constants.
"""

from dataclasses import dataclass
from typing import Annotated, Literal

from annotated_types import Gt, Lt, doc

from navigation.parameters.bounds import NonNegative, Positive


@dataclass(frozen=True)
class UnivectorParameters:
    """Univector field (7)-(10)."""

    s_robot: Annotated[Positive, "m", doc("Radius of the robot [m].")] = 0.12
    margin: Annotated[NonNegative, "m", doc("Margin added to the robot's radius in S_r [m].")] = (
        0.03
    )
    eta_vo: Annotated[
        NonNegative, "s", doc("Gain of the extended radius on the speed of the obstacle [s].")
    ] = 0.5
    eta_imp: Annotated[
        NonNegative, "m", doc("Gain of the extended radius on the partial evaluations [m].")
    ] = 0.05
    d_con: Annotated[
        Positive, "m", doc("Distance within which the field bends towards the arrival heading [m].")
    ] = 0.80
    arrival: Annotated[
        Literal["hard", "ramped", "nposture"],
        doc("Experimental. (8): switched at d_con as printed, ramped in, or Kim's posture field."),
    ] = "ramped"
    d_e: Annotated[Positive, "m", doc("Radius offset of the spiral (9) [m].")] = 0.20
    d_b: Annotated[Positive, "m", doc("Width of the outer band of (9) [m].")] = 0.25
    k_r: Annotated[Positive, "m", doc("Curvature of the outer spiral (9) [m].")] = 0.30
    inside: Annotated[
        Literal["zero", "outward"],
        doc(
            "Experimental. Field inside the extended radius: zero as printed, or straight outward."
        ),
    ] = "outward"
    blend: Annotated[
        Literal["weights", "distance"],
        doc("Experimental. (10): fixed weights as printed, or weights by distance."),
    ] = "distance"
    w_muf: Annotated[NonNegative, doc("Weight of move-to-goal for fixed weights [1].")] = 0.75
    w_auf: Annotated[NonNegative, doc("Weight of avoid-obstacle for fixed weights [1].")] = 0.25
    grouping: Annotated[
        bool,
        doc(
            "Experimental. Whether obstacles with gaps too narrow for the robot are passed on one "
            "side."
        ),
    ] = False
    side_memory: Annotated[
        bool, doc("Experimental. Whether the passing side of an obstacle is kept while it is near.")
    ] = False

    omega_soe: float = 1.0  # weight of speed and uncertainty in (7) [1]
    k_alpha: float = 1.0  # arrival gain on the bearing of the destination [1]
    k_beta: float = -0.6  # arrival gain on the remaining heading error, negative [1]
    arrival_clamp: float = 1.3  # maximum deviation of the ramped field from the destination [rad]
    arrival_ramp: float = 0.5  # width of the ramp as a fraction of d_con [1]
    side_set: float = 2.304  # |beta| above which the ramped arrival latches its side [rad]
    side_clear: float = 1.798  # |beta| below which the ramped arrival releases its side [rad]
    posture_gain: float = 8.0  # gain of Kim's posture field [1]
    # distance of its reference point beyond the destination
    posture_offset: Annotated[float, "m"] = 0.25
    # distance within which the body turns to the goal heading
    holonomic_distance: Annotated[float, "m"] = 0.45
    slow_distance: Annotated[float, "m"] = 0.30  # distance from the goal within which k_rho falls
    slow_fraction: float = 0.2  # k_rho at the goal [1]
    goal_fraction: float = 0.6  # fraction of the room at a destination left to an obstacle [1]
    min_goal_gap: Annotated[float, "m"] = 0.02  # lower bound of that room
    min_goal_offset: Annotated[float, "m"] = 0.03  # lower bound of d_e at a destination
    virtual_weight: float = 1.5  # weight of dynamic virtual obstacles in the blend by distance [1]
    # time unseen after which only the safety filter avoids a mover
    memory: Annotated[float, "s"] = 1.0


@dataclass(frozen=True)
class MovingObstacleParameters:
    """Dynamic virtual obstacle (11) and velocity modification."""

    virtual_obstacle: Annotated[
        Literal["off", "printed", "uncapped"],
        doc("Experimental. (11): off, as printed, or uncapped with a remembered side."),
    ] = "uncapped"
    xi: Annotated[
        float, Gt(0.0), Lt(1.0), doc("Convexity of the dynamic virtual obstacle [1].")
    ] = 0.6
    velocity_modification: Annotated[
        Literal["off", "closed", "sampled"],
        doc("Experimental. Velocity modification: off, roots of the quadratic, or sampled speeds."),
    ] = "sampled"
    radius: Annotated[
        Literal["extended", "physical"],
        doc(
            "Experimental. Radius in velocity modification: S_oe, or the physical radii and a "
            "margin."
        ),
    ] = "physical"
    margin: Annotated[NonNegative, "m", doc("Margin added to the physical radii [m].")] = 0.05
    horizon: Annotated[
        Positive, "s", doc("Maximum time to collision in velocity modification [s].")
    ] = 6.0
    wait_in_band: Annotated[
        bool,
        doc(
            "Experimental. Whether a robot inside the collision band may brake, which only delays "
            "the collision."
        ),
    ] = True

    omega_dist: float = 12.0  # length of the virtual path in (11) as printed [1]
    path_time: Annotated[float, "s"] = 6.0  # length of the uncapped virtual path per relative speed
    # distance from the path within which the goal decides the side
    side_switch: Annotated[float, "m"] = 0.05
    # distance beyond the path at which the uncapped form changes side
    side_hold: Annotated[float, "m"] = 0.08
    side_aligned: float = 0.2  # sine of path to goal below which the goal does not decide [1]
    min_speed: Annotated[float, "m/s"] = 0.015  # speed below which an obstacle has no virtual path
    samples: int = 21  # number of sampled speeds [1]
    acceleration_time: Annotated[float, "s"] = 0.8  # time over which a sampled speed may be reached


@dataclass(frozen=True)
class UnseenGroundParameters:
    """Speed limit towards ground that was not seen recently."""

    enabled: Annotated[bool, doc("Experimental. Whether unseen ground limits the speed.")] = True

    confidence: float = 0.3  # confidence below which ground counts as unseen [1]
    # nearest ground checked; a look 20 deg down shows none nearer
    near: Annotated[float, "m"] = 0.36
    far: Annotated[float, "m"] = 0.60  # farthest ground checked
    half_width: Annotated[float, "m"] = 0.10  # half width of the ground checked
    rows: int = 4  # rows of points from the nearest to the farthest [1]
    speed: Annotated[float, "m/s"] = 0.03  # maximum speed towards unseen ground


@dataclass(frozen=True)
class SafetyFilterParameters:
    """Safety filter: time to collision of rolled-out footsteps."""

    enabled: Annotated[bool, doc("Experimental. Whether the safety filter is used.")] = True
    reachable: Annotated[
        bool, doc("Experimental. Whether an unseen mover also counts as its reachable set.")
    ] = False
    margin: Annotated[
        NonNegative,
        "m",
        doc(
            "Distance to the bodies of obstacles, for a stepping foot beyond `univector.s_robot` "
            "[m]."
        ),
    ] = 0.045

    headings: int = 24  # number of candidate directions [1]
    speeds: int = 6  # number of candidate speeds per direction [1]
    steps: int = 4  # footsteps in the rollout before the straight path [1]
    # maximum change of the turn rate between footsteps
    turn_change: Annotated[float, "rad/s"] = 0.4
    static_horizon: Annotated[float, "s"] = 2.0  # maximum time to collision with static obstacles
    moving_horizon: Annotated[float, "s"] = 6.0  # maximum time to collision with movers
    # time over which the path of a turning mover is averaged
    bend_time: Annotated[float, "s"] = 2.0
    # maximum time to collision with the reversal of a mover
    reversal_horizon: Annotated[float, "s"] = 2.5
    urgent_time: Annotated[float, "s"] = 1.5  # time to collision below which a collision is urgent
    urgent_weight: float = 20.0  # penalty of an urgent collision [1]
    weight: float = 6.0  # penalty of any other collision [1]
    change_weight: float = 0.15  # penalty of a change of velocity [1]
    particle_weight: float = 2.0  # weight of all particles of a lost mover together [1]
    reversal_weight: float = 0.12  # weight of the reversal of a visible mover [1]
    reachable_radius: Annotated[float, "m"] = 0.4  # maximum growth of the reachable set
    reachable_delay: Annotated[float, "s"] = 0.3  # time unseen before the reachable set grows
    # time unseen after which the reachable set is dropped
    reachable_age: Annotated[float, "s"] = 6.0
    # maximum position uncertainty added to the radius of a mover
    max_sigma: Annotated[float, "m"] = 0.06
    inside_weight: float = 10.0  # penalty of a collision with a disc that contains the robot [1]
    inside_depth: float = 40.0  # additional penalty per depth as a fraction of its radius [1]
    inside_closing: Annotated[float, "s/m"] = 100.0  # additional penalty per closing speed


@dataclass(frozen=True)
class LandmarkParameters:
    """Landmarks of the map as obstacles."""

    attention_range: Annotated[float, "m"] = 1.0  # maximum distance of a landmark that counts
    # Standard deviations of position and velocity, as of a static track known for long.
    sigma: Annotated[float, "m"] = 0.005
    velocity_sigma: Annotated[float, "m/s"] = 0.005


@dataclass(frozen=True)
class WaypointSearchParameters:
    """Waypoints around static obstacles that block the straight path."""

    enabled: Annotated[bool, doc("Experimental. Whether waypoints are searched for.")] = False

    cell: Annotated[float, "m"] = 0.10  # side of a grid cell
    reach: Annotated[float, "m"] = 1.2  # maximum distance of the waypoint
    around: Annotated[float, "m"] = 1.0  # margin of the grid around robot and destination


@dataclass(frozen=True)
class VelocityMappingParameters:
    """Velocity mapping from direction and speed to a body velocity."""

    turn_gain: Annotated[float, "1/s"] = 1.5  # turn rate per heading error
    turn_first_angle: float = 0.5  # heading error above which a fast path starts with a turn [rad]
    sidestep_ratio: float = 1.2  # speed of a fast path, ratio to the maximum lateral speed [1]
    # turn rate of a lost robot, which searches for beacons
    lost_turn_rate: Annotated[float, "rad/s"] = 0.5
