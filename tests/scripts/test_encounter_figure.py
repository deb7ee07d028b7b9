"""The arrow at a virtual obstacle in the figure of the encounters."""

import numpy as np
import pytest
from encounter_figure import foot_velocity


def test_the_foot_moves_as_the_robot_does_along_the_path():
    """The finite difference of the projection of the robot on the path of the mover."""
    rng = np.random.default_rng(0)
    for path, robot, v in rng.normal(size=(50, 3, 2)):
        u = path / np.hypot(*path)
        here, there = ((at @ u) * u for at in (robot, robot + 1e-6 * v))
        assert foot_velocity(v, here) == pytest.approx((there - here) / 1e-6, abs=1e-6)
