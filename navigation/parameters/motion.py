"""Parameters of the motion: univector field, safety filter, velocity mapping.

Public keys of a scenario have bounds and a docstring; all other fields are for studies.
"""

from dataclasses import dataclass
from typing import Annotated

from annotated_types import doc

from navigation.parameters.bounds import NonNegative, Positive


@dataclass(frozen=True)
class UnivectorParameters:
    """Extended radius (7), and the univector field (8)-(10) of the default planner."""

    s_robot: Annotated[Positive, "m", doc("Radius of the robot [m].")] = 0.12
    margin: Annotated[NonNegative, "m", doc("Margin added to the robot's radius in S_r [m].")] = (
        0.06
    )
    eta_vo: Annotated[
        NonNegative, "s", doc("Gain of the extended radius on the speed of the obstacle [s].")
    ] = 0.31
    eta_imp: Annotated[
        NonNegative, "m", doc("Gain of the extended radius on the partial evaluations [m].")
    ] = 0.05
    d_con: Annotated[
        Positive, "m", doc("Distance within which the field bends towards the arrival heading [m].")
    ] = 0.80
    d_e: Annotated[
        Positive, "m", doc('Radius offset of the spiral (9), method "univector" [m].')
    ] = 0.125
    d_b: Annotated[
        Positive, "m", doc('Width of the outer band of (9), method "univector" [m].')
    ] = 0.34
    k_r: Annotated[
        Positive, "m", doc('Curvature of the outer spiral (9), method "univector" [m].')
    ] = 0.105

    k_beta: float = -0.6  # arrival gain on the remaining heading error, negative [1]
    arrival_clamp: float = 1.3  # maximum deviation of the field from the destination [rad]
    arrival_ramp: float = 0.5  # width of the ramp as a fraction of d_con [1]
    side_set: float = 2.304  # |beta| above which the arrival latches its side [rad]
    side_clear: float = 1.798  # |beta| below which the arrival releases its side [rad]
    # distance within which the body turns to the goal heading
    holonomic_distance: Annotated[float, "m"] = 0.45
    # distance from the goal within which k_rho falls
    slow_distance: Annotated[Positive, "m"] = 0.30
    slow_fraction: float = 0.2  # k_rho at the goal [1]
    goal_fraction: float = 0.6  # fraction of the room at a destination left to an obstacle [1]
    min_goal_gap: Annotated[float, "m"] = 0.02  # lower bound of that room
    min_goal_offset: Annotated[float, "m"] = 0.03  # lower bound of d_e at a destination
    # cosine of the bearing from which an obstacle ahead has its full effect [1]
    fade: Positive = 0.5
    # depth in an extended radius at which an obstacle abeam or behind has its full effect
    inside: Annotated[Positive, "m"] = 0.02
    # time unseen after which only the safety filter avoids a mover
    memory: Annotated[float, "s"] = 4.0


@dataclass(frozen=True)
class SafetyFilterParameters:
    """Safety filter: losses of rolled-out footsteps, in seconds."""

    enabled: Annotated[bool, doc("Experimental. Whether the safety filter is used.")] = True
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
    # maximum change of the turn rate between footsteps
    turn_change: Annotated[float, "rad/s"] = 0.4
    static_horizon: Annotated[float, "s"] = 2.0  # maximum time to collision with static obstacles
    moving_horizon: Annotated[float, "s"] = 3.5  # maximum time to collision with movers
    # time over which the path of a turning mover is averaged
    bend_time: Annotated[float, "s"] = 2.0
    # maximum time to collision with the reversal of a mover
    reversal_horizon: Annotated[float, "s"] = 2.5
    urgent_time: Annotated[float, "s"] = 1.5  # time to collision below which a collision is urgent
    urgent_loss: Annotated[float, "s"] = 70.0  # loss by an urgent collision
    collision_loss: Annotated[float, "s"] = 21.0  # loss by any other collision
    inside_loss: Annotated[float, "s"] = 35.0  # loss by a start inside a disc
    depth_loss: Annotated[float, "s"] = 140.0  # the same per depth, as a fraction of the radius
    closing_loss: Annotated[float, "s"] = 70.0  # the same per closing speed, ratio to the maximum
    change_loss: Annotated[float, "s"] = 0.5  # loss by a change of velocity, ratio to the maximum
    comfort: Annotated[float, "m"] = 0.15  # gap below which a passage is too close
    close_loss: Annotated[float, "s"] = 3.0  # loss by a passage without gap
    particle_weight: float = 0.5  # weight of all particles of a lost mover together [1]
    reversal_weight: float = 0.12  # weight of the reversal of a visible mover [1]
    # maximum position uncertainty added to the radius of a mover
    max_sigma: Annotated[float, "m"] = 0.06


@dataclass(frozen=True)
class LandmarkParameters:
    """Landmarks of the map as obstacles."""

    attention_range: Annotated[float, "m"] = 1.0  # maximum distance of a landmark that counts
    # Standard deviations of position and velocity, as of a static track known for long.
    sigma: Annotated[float, "m"] = 0.005
    velocity_sigma: Annotated[float, "m/s"] = 0.005


@dataclass(frozen=True)
class VelocityMappingParameters:
    """Velocity mapping from direction and speed to a body velocity."""

    turn_gain: Annotated[float, "1/s"] = 1.5  # turn rate per heading error
    # turn rate of a lost robot, which searches for beacons
    lost_turn_rate: Annotated[float, "rad/s"] = 0.5
