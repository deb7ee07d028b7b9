import numpy as np
import pytest

from navigation.angles import wrap_array
from navigation.baselines.n_posture import NPosture
from navigation.parameters.planner import NPostureParameters

P = NPostureParameters()


def desired(planning, task, *tracks, **details):
    return NPosture(P).desired(planning(tracks, task, **details))


def test_without_obstacles_the_field_turns_by_the_angle_to_the_point_beyond(planning, task):
    """phi = angle(g - p) - n (angle(r - p) - angle(g - p)), r beyond the destination."""
    beyond = np.arctan2(P.offset, 0.4)
    w = desired(planning, task((0.4, 0.0), np.pi / 2))
    assert w.direction == pytest.approx(-P.gain * beyond)
    assert np.hypot(*w.velocity) == pytest.approx(0.2)


def test_the_field_never_leads_away_from_the_destination(planning, task):
    rng = np.random.default_rng(0)
    for x, y, heading in rng.uniform((-0.3, -0.3, -3.0), (0.3, 0.3, 3.0), (100, 3)).tolist():
        direction = desired(planning, task((x, y), heading)).direction
        off = wrap_array(direction - np.arctan2(y, x))
        assert abs(float(off)) <= 0.5 * np.pi + 1e-9


def test_at_the_gap_of_full_weight_the_obstacle_decides_alone(planning, task, track):
    gap = 0.2 + P.margin + 0.5 * P.d_min
    w = desired(planning, task((2.0, 0.0)), track((0.0, gap)))
    assert w.velocity == pytest.approx([0.0, -0.2], abs=1e-6)


def test_a_mover_is_displaced_by_its_relative_velocity(planning, task, track):
    """A mover from the left at the robot's own speed ahead is met further ahead."""
    still, moving = (
        desired(planning, task((2.0, 0.0)), track((0.5, 0.15), v)).velocity
        for v in ((0.0, 0.0), (0.0, -0.15))
    )
    assert moving[1] > still[1]
