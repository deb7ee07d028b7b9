"""The planner a scenario asks for by name."""

from collections.abc import Callable

import numpy as np

from navigation.baselines.baseline_planner import Avoidance, BaselinePlanner
from navigation.baselines.dynamic_window import DynamicWindow
from navigation.baselines.n_posture import NPosture
from navigation.baselines.orca import Orca
from navigation.baselines.path_integral import PathIntegral
from navigation.baselines.plain_univector import PlainUnivector
from navigation.baselines.potential_field import PotentialField
from navigation.decision import SpeedLimits
from navigation.motion.planner import Planner
from navigation.parameters.navigation import NavigationParameters


def build_planner(
    parameters: NavigationParameters, limits: SpeedLimits, rng: np.random.Generator
) -> Planner | BaselinePlanner:
    """The planner named by `parameters.planner.method`.

    Args:
        parameters: of all decisions.
        limits: envelope of the walking layer.
        rng: for the planner that draws samples.
    """
    p, s_robot = parameters.planner, parameters.univector.s_robot
    if p.method == "univector":
        return Planner(parameters, limits)
    baselines: dict[str, Callable[[], Avoidance]] = {
        "univector-plain": lambda: PlainUnivector(parameters),
        "n-posture": lambda: NPosture(p.n_posture, s_robot),
        "apf": lambda: PotentialField(p.apf, s_robot),
        "orca": lambda: Orca(p.orca, s_robot),
        "dwa": lambda: DynamicWindow(p.dwa, s_robot),
        "mppi": lambda: PathIntegral(p.mppi, s_robot, rng),
    }
    return BaselinePlanner(parameters, limits, baselines[p.method]())
