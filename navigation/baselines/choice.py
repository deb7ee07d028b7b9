"""Choice of the planner by the method of the scenario."""

import numpy as np

from navigation.baselines.baseline_planner import Avoidance, BaselinePlanner
from navigation.baselines.fields import PlainUnivector, PotentialField
from navigation.baselines.n_posture import NPosture
from navigation.baselines.orca import Orca
from navigation.baselines.sampling import DynamicWindow, PathIntegral
from navigation.decision import SpeedLimits
from navigation.motion.planner import Planner
from navigation.parameters.navigation import NavigationParameters


def build_planner(
    parameters: NavigationParameters, limits: SpeedLimits, rng: np.random.Generator
) -> Planner | BaselinePlanner:
    """Build the planner of `parameters.planner.method`.

    Args:
        parameters: parameters of all decisions.
        limits: speed limits of the walking layer.
        rng: generator of the samples of `mppi`.
    """
    p = parameters.planner
    avoidance: Avoidance
    match p.method:
        case "univector":
            return Planner(parameters, limits)
        case "univector-plain":
            avoidance = PlainUnivector(parameters)
        case "n-posture":
            avoidance = NPosture(p.n_posture)
        case "apf":
            avoidance = PotentialField(p.apf)
        case "orca":
            avoidance = Orca(p.orca)
        case "dwa":
            avoidance = DynamicWindow(p.dwa)
        case "mppi":
            avoidance = PathIntegral(p.mppi, rng)
    return BaselinePlanner(parameters, limits, avoidance)
