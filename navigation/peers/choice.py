"""The planner a scenario asks for by name."""

from collections.abc import Callable

import numpy as np

from navigation.decision import SpeedLimits
from navigation.motion.planner import Planner
from navigation.parameters.navigation import NavigationParameters
from navigation.peers.dynamic_window import DynamicWindow
from navigation.peers.n_posture import NPosture
from navigation.peers.orca import Orca
from navigation.peers.path_integral import PathIntegral
from navigation.peers.peer_planner import Avoids, PeerPlanner
from navigation.peers.plain_univector import PlainUnivector
from navigation.peers.potential_field import PotentialField


def build_planner(
    parameters: NavigationParameters, limits: SpeedLimits, rng: np.random.Generator
) -> Planner | PeerPlanner:
    """The planner named by `parameters.planner.method`.

    Args:
        parameters: of all decisions.
        limits: envelope of the walking layer.
        rng: for the planner that draws samples.
    """
    p, s_robot = parameters.planner, parameters.univector.s_robot
    if p.method == "univector":
        return Planner(parameters, limits)
    peers: dict[str, Callable[[], Avoids]] = {
        "univector-plain": lambda: PlainUnivector(parameters),
        "n-posture": lambda: NPosture(p.n_posture, s_robot),
        "apf": lambda: PotentialField(p.apf, s_robot),
        "orca": lambda: Orca(p.orca, s_robot),
        "dwa": lambda: DynamicWindow(p.dwa, s_robot),
        "mppi": lambda: PathIntegral(p.mppi, s_robot, rng),
    }
    return PeerPlanner(parameters, limits, peers[p.method]())
