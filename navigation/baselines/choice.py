"""Choice of the planner by the method of the scenario."""

import numpy as np

from navigation.baselines.fields import PotentialField
from navigation.baselines.n_posture import NPosture
from navigation.baselines.orca import Orca
from navigation.baselines.sampling import DynamicWindow, PathIntegral
from navigation.decision import SpeedLimits
from navigation.motion.planner import Planner
from navigation.motion.planning_scene import Method
from navigation.motion.univector import Univector
from navigation.paper import PaperMethod
from navigation.parameters.navigation import NavigationParameters


def build_planner(
    parameters: NavigationParameters, limits: SpeedLimits, rng: np.random.Generator
) -> Planner:
    """Build the planner of `parameters.planner.method`.

    Args:
        parameters: parameters of all decisions.
        limits: speed limits of the walking layer.
        rng: generator of the samples of `mppi`.
    """
    p = parameters.planner
    method: Method
    filtered = False
    match p.method:
        case "univector":
            method, filtered = Univector(), parameters.safety_filter.enabled
        case "paper":
            method = PaperMethod(p.paper)
        case "n-posture":
            method = NPosture(p.n_posture)
        case "apf":
            method = PotentialField(p.apf)
        case "orca":
            method = Orca(p.orca)
        case "dwa":
            method = DynamicWindow(p.dwa)
        case "mppi":
            method = PathIntegral(p.mppi, rng)
    return Planner(parameters, limits, method, filtered=filtered)
