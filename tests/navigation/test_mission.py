from math import pi

import numpy as np
import pytest

from navigation.mission import Mission
from navigation.parameters.navigation import MissionParameters

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def at(x, y, heading=0.0):
    return np.array([x, y, heading])


def test_via_points_come_in_order_and_point_to_the_next():
    mission = Mission(SQUARE, 1.0, False, MissionParameters())
    headings = [0.0, pi / 2, pi, 1.0]
    for index, (point, heading) in enumerate(zip(SQUARE, headings, strict=True)):
        task = mission.update(at(*(point + 0.4)))
        assert task.index == index
        assert task.target == pytest.approx(point)
        assert task.heading == pytest.approx(heading)
        assert task.is_goal == (index == 3)
        mission.update(at(*(point + 0.1)))


def test_a_point_is_passed_within_its_radius_only():
    p = MissionParameters()
    mission = Mission(SQUARE, None, False, p)
    assert mission.update(at(0.0, p.r_via + 0.001)).index == 0
    assert mission.update(at(0.0, p.r_via - 0.001)).index == 1


def test_a_tour_within_reach_is_walked_once_round_at_each_update():
    mission = Mission(0.1 * SQUARE, None, True, MissionParameters(r_via=0.5))
    assert [mission.update(at(0.0, 0.0)).index for _ in range(3)] == [4, 8, 12]


def test_goal_is_reached_then_turned_at_then_done_for_good():
    p = MissionParameters()
    mission = Mission(np.array([[1.0, 0.0]]), pi / 2, False, p)
    assert not mission.update(at(0.5, 0.0)).aligning
    turning = mission.update(at(1.0 - 0.9 * p.r_goal, 0.0))
    assert turning.aligning
    assert not turning.done
    done = mission.update(at(1.0, 0.0, pi / 2 - 0.5 * p.heading_tolerance))
    assert done.done
    assert not done.aligning
    assert mission.update(at(5.0, 5.0)).done


def test_a_robot_pushed_off_the_goal_walks_back():
    p = MissionParameters()
    mission = Mission(np.array([[1.0, 0.0]]), pi / 2, False, p)
    mission.update(at(1.0, 0.0))
    between = 0.5 * (p.r_goal + p.r_release)
    assert mission.update(at(1.0 + between, 0.0)).aligning
    assert not mission.update(at(1.01 + p.r_release, 0.0)).aligning


def test_endless_tour_cycles():
    mission = Mission(SQUARE, None, True, MissionParameters())
    for lap in range(3):
        for index, point in enumerate(SQUARE):
            task = mission.update(at(*point))
            assert task.index == 4 * lap + index + 1
            assert not task.is_goal
            assert not task.done
            assert task.target == pytest.approx(SQUARE[(index + 1) % 4])


@pytest.mark.parametrize(
    ("points", "endless"),
    [(np.zeros((0, 2)), False), (np.zeros((1, 2)), True), (np.ones(2), False)],
)
def test_too_few_points_are_refused(points, endless):
    with pytest.raises(ValueError, match="waypoints"):
        Mission(points, None, endless, MissionParameters())
