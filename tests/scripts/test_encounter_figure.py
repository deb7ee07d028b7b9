"""The arrow at a virtual obstacle in the figure of the encounters."""

import numpy as np
import pytest
from encounter_figure import foot_velocity

from navigation.motion.virtual_obstacle import path_point


def test_the_foot_moves_as_the_robot_does_along_the_path():
    rng = np.random.default_rng(0)
    for _ in range(50):
        u, robot, v = rng.normal(size=2), rng.normal(size=2), rng.normal(size=2)
        here, there = (path_point(at, np.zeros(2), u) for at in (robot, robot + 1e-6 * v))
        if here is None or there is None:
            continue
        slope = np.array([there.x - here.x, there.y - here.y]) / 1e-6
        assert foot_velocity(v, here) == pytest.approx(slope, abs=1e-6)
