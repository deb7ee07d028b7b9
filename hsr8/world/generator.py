"""Draws fair worlds: nothing is impossible from the start, and chance alone decides the rest.

The rules, with distances between surfaces unless a point is named:

* static obstacles leave gaps of two robot radii and 0.16 m;
* the start is a point 0.35 m from static obstacles and 0.9 m from movers;
* via points and the goal are robot radius and 0.25 m from static obstacles;
* lanes of movers keep 0.3 m from static obstacles, so that none pins the robot, keep
  clear of one another, and turn about robot radius and 0.3 m from the goal at least;
* movers that wander or cross the field may cross lanes, but never meet another mover.
"""

import zlib

import numpy as np

from hsr8.errors import ScenarioError
from hsr8.scenario.schema import Scenario
from hsr8.world.attempt import Attempt, CrowdedError
from hsr8.world.layout import Layout

WORLDS = 20  # worlds begun before giving up


def draw_layout(scenario: Scenario, seed: int) -> Layout:
    """World of `scenario` for `seed`: the same two give the same world.

    Raises:
        ScenarioError: what is asked for does not fit into the field.
    """
    sequence = np.random.SeedSequence(entropy=seed, spawn_key=(zlib.crc32(b"layout"),))
    rng = np.random.default_rng(sequence)
    reasons: dict[str, int] = {}
    for _ in range(WORLDS):
        try:
            return Attempt(scenario, rng).layout()
        except CrowdedError as crowded:
            reasons[str(crowded)] = reasons.get(str(crowded), 0) + 1
    worst = max(reasons, key=lambda reason: reasons[reason])
    width, depth = scenario.world.size
    raise ScenarioError(
        f"scenario {scenario.name!r}, seed {seed}: no fair world found in {WORLDS} attempts, "
        f"most often for want of room for {worst} in a field of {width:g} m x {depth:g} m; "
        "make world.size larger or world.n_static, world.n_moving or world.radius smaller"
    )
