import numpy as np
import pytest

from navigation.motion.virtual_obstacle import (
    VirtualSides,
    oval,
    path_point,
    printed_path_length,
    printed_radius,
)
from navigation.parameters.motion import MovingObstacleParameters

OBSTACLE, VELOCITY = np.zeros(2), np.array([0.1, 0.0])


def foot(x, y, velocity=VELOCITY, obstacle=OBSTACLE):
    return path_point(np.array([x, y]), obstacle, np.asarray(velocity))


@pytest.mark.parametrize("xi", [0.2, 0.4, 0.5, 0.6, 0.8])
def test_the_oval_starts_at_one_is_xi_in_the_middle_and_ends_at_zero(xi):
    assert oval(0.0, xi) == pytest.approx(1.0)
    assert oval(0.5, xi) == pytest.approx(xi)
    assert oval(1.0, xi) == pytest.approx(0.0)
    h = [oval(k / 100, xi) for k in range(101)]
    assert np.all(np.diff(h) < 0.0)


def test_the_oval_is_concave_above_a_half_linear_at_it_and_continuous_there():
    h = np.linspace(0.0, 1.0, 101)
    assert np.all(np.diff([oval(x, 0.7) for x in h], 2) < 0.0)
    assert np.all(np.diff([oval(x, 0.3) for x in h], 2) > 0.0)
    assert [oval(x, 0.5) for x in h] == pytest.approx(1.0 - h)
    for x in h.tolist():
        assert oval(x, 0.5 + 2.6e-5) == pytest.approx(oval(x, 0.5), abs=3e-5)


def test_the_foot_is_the_projection_on_the_path():
    f = foot(1.0, 0.3)
    assert (f.x, f.y, f.along, f.lateral) == pytest.approx((1.0, 0.0, 1.0, 0.3))
    assert foot(-0.1, 0.3) is None
    assert f.normal(1) == pytest.approx((0.0, 1.0))
    assert f.normal(-1) == pytest.approx((0.0, -1.0))


def test_the_printed_radius_never_reaches_over_the_robot():
    rng = np.random.default_rng(1)
    active = 0
    for x, y in rng.uniform(-1, 1, (300, 2)).tolist():
        f = foot(x, y)
        if f is None:
            continue
        radius = printed_radius(f, 0.3, 0.8, 0.6)
        if radius is None:
            continue
        assert radius <= abs(f.lateral) + 1e-12
        assert radius <= 0.3
        active += 1
    assert active > 50


def test_beyond_its_length_the_path_is_free():
    assert printed_radius(foot(0.79, 0.2), 0.3, 0.8, 0.6) > 0.0
    assert printed_radius(foot(0.81, 0.2), 0.3, 0.8, 0.6) is None
    assert printed_radius(foot(0.5, 0.0), 0.3, 0.8, 0.6) == 0.0
    assert printed_path_length(0.2, 0.5, 12.0, 0.5, 0.05) == pytest.approx(1.5)
    assert printed_path_length(0.0, 0.5, 12.0, 0.5, 0.05) == pytest.approx(0.3)
    assert printed_radius(foot(0.4, 0.9), 0.3, 0.8, 0.6) == pytest.approx(0.6 * 0.3)
    assert printed_radius(foot(0.4, 0.1), 0.3, 0.8, 0.6) == pytest.approx(0.1)


def test_the_side_is_kept_until_the_robot_is_well_over():
    sides = VirtualSides(MovingObstacleParameters())
    ahead = (1.0, 0.0)
    assert sides.update(1, foot(1.0, 0.2), ahead) == 1
    assert sides.update(1, foot(1.0, -0.07), ahead) == 1
    assert sides.update(1, foot(1.0, -0.09), ahead) == -1
    assert sides.update(1, foot(1.0, 0.05), ahead) == -1


def test_near_the_path_the_goal_decides_the_side():
    across = (0.0, 1.0)
    assert VirtualSides(MovingObstacleParameters()).update(1, foot(1.0, -0.02), across) == 1
    assert VirtualSides(MovingObstacleParameters()).update(1, foot(1.0, -0.02), (1.0, 0.0)) == -1
    sides = VirtualSides(MovingObstacleParameters())
    sides.update(1, foot(1.0, -0.02), across)
    sides.keep(set())
    assert sides.update(1, foot(1.0, -0.02), (0.0, -1.0)) == -1


def test_far_from_the_path_the_present_side_decides():
    p = MovingObstacleParameters()
    far = p.side_switch + 0.01
    assert VirtualSides(p).update(1, foot(1.0, far), (0.0, -1.0)) == 1
    assert VirtualSides(p).update(1, foot(1.0, -far), (0.0, 1.0)) == -1
    assert VirtualSides(p).update(1, foot(1.0, 0.02), (0.0, -1.0)) == -1


def test_the_path_point_does_not_depend_on_the_frame(rotation):
    r, shift = rotation(0.8), np.array([3.0, -1.0])
    for robot in np.random.default_rng(3).uniform((0.1, -1.0), (1.0, 1.0), (20, 2)):
        here = foot(*robot)
        there = foot(*(r @ robot + shift), r @ VELOCITY, shift)
        assert (there.along, there.lateral) == pytest.approx((here.along, here.lateral))
        assert (there.x, there.y) == pytest.approx(r @ [here.x, here.y] + shift)
        sides = []
        for point, turn in ((here, np.eye(2)), (there, r)):
            goal = turn @ [0.6, 0.8]
            sides.append(VirtualSides(MovingObstacleParameters()).update(1, point, tuple(goal)))
            assert point.normal(1) == pytest.approx(turn @ here.normal(1))
        assert sides[0] == sides[1]
