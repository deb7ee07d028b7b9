"""Parameters of the decisions: mission, gaze, planner and motion.

The defaults are the profile `extended`; `NavigationParameters.paper` is the reference with the
printed structure.
"""

from dataclasses import dataclass, field
from math import pi
from typing import Annotated

from annotated_types import doc

from navigation.parameters.bounds import Positive
from navigation.parameters.gaze import EvaluationParameters, GazeParameters
from navigation.parameters.motion import (
    LandmarkParameters,
    MovingObstacleParameters,
    SafetyFilterParameters,
    UnivectorParameters,
    UnseenGroundParameters,
    VelocityMappingParameters,
    WaypointSearchParameters,
)
from navigation.parameters.planner import PlannerParameters


@dataclass(frozen=True)
class MissionParameters:
    """Via points and arrival at the goal."""

    r_via: Annotated[Positive, "m", doc("Distance at which a via point is passed [m].")] = 0.15
    r_goal: Annotated[
        Positive,
        "m",
        doc("Distance at which the goal is reached and the turn to its heading begins [m]."),
    ] = 0.05
    heading_tolerance: Annotated[
        Positive, doc("Heading error at which the mission is done [rad].")
    ] = 0.07

    # distance at which a robot that turns at the goal walks back
    r_release: Annotated[float, "m"] = 0.08


@dataclass(frozen=True)
class NavigationParameters:
    """All parameters of the decisions; the defaults are the profile `extended`."""

    mission: MissionParameters = field(default_factory=MissionParameters)
    evaluation: EvaluationParameters = field(default_factory=EvaluationParameters)
    gaze: GazeParameters = field(default_factory=GazeParameters)
    planner: PlannerParameters = field(default_factory=PlannerParameters)
    univector: UnivectorParameters = field(default_factory=UnivectorParameters)
    moving_obstacles: MovingObstacleParameters = field(default_factory=MovingObstacleParameters)
    unseen_ground: UnseenGroundParameters = field(default_factory=UnseenGroundParameters)
    safety_filter: SafetyFilterParameters = field(default_factory=SafetyFilterParameters)
    landmarks: LandmarkParameters = field(default_factory=LandmarkParameters)
    waypoint_search: WaypointSearchParameters = field(default_factory=WaypointSearchParameters)
    velocity_mapping: VelocityMappingParameters = field(default_factory=VelocityMappingParameters)

    @classmethod
    def extended(cls) -> "NavigationParameters":
        """Profile `extended`, the defaults."""
        return cls()

    @classmethod
    def paper(cls) -> "NavigationParameters":
        """Profile `paper`: printed structure and constants with the minimum of repairs."""
        return cls(
            evaluation=EvaluationParameters(map_ratio="printed", t_heading=0.0),
            gaze=GazeParameters(
                mode="integrated",
                step=pi / 36.0,
                w_lm=0.21,
                w_way=0.17,
                w_sf=0.29,
                w_ob=0.33,
                box_fraction=0.5,
                obstacle_votes="mean",
                map_votes="mean",
                candidates="obstacles",
                switch_ratio=1.0,
            ),
            univector=UnivectorParameters(
                arrival="hard",
                k_beta=-0.5,
                holonomic_distance=0.0,
                d_e=0.40,
                d_b=0.80,
                inside="zero",
                blend="weights",
                memory=25.0,
            ),
            moving_obstacles=MovingObstacleParameters(
                virtual_obstacle="printed",
                velocity_modification="closed",
                radius="extended",
                wait_in_band=False,
            ),
            unseen_ground=UnseenGroundParameters(enabled=False),
            safety_filter=SafetyFilterParameters(enabled=False),
        )
