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
    SafetyFilterParameters,
    UnivectorParameters,
    VelocityMappingParameters,
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
    safety_filter: SafetyFilterParameters = field(default_factory=SafetyFilterParameters)
    landmarks: LandmarkParameters = field(default_factory=LandmarkParameters)
    velocity_mapping: VelocityMappingParameters = field(default_factory=VelocityMappingParameters)

    @classmethod
    def extended(cls) -> "NavigationParameters":
        """Profile `extended`, the defaults."""
        return cls()

    @classmethod
    def paper(cls) -> "NavigationParameters":
        """Profile `paper`: printed structure and constants with the minimum of repairs."""
        return cls(
            evaluation=EvaluationParameters(t_heading=0.0),
            gaze=GazeParameters(
                mode="integrated",
                step=pi / 36.0,
                w_lm=0.21,
                w_way=0.17,
                w_sf=0.29,
                w_ob=0.33,
            ),
            planner=PlannerParameters(method="paper"),
            univector=UnivectorParameters(
                margin=0.0865, eta_vo=0.108, eta_imp=0.021, holonomic_distance=0.0
            ),
        )
