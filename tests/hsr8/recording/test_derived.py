"""Quantities derived from the tables of a run."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.recording.derived import (
    Speedometer,
    WorldFrame,
    ellipse_axes,
    loaded_cop,
    mean_velocity,
    pushes_of,
    strides,
    walk_of,
)
from hsr8.robots.loaded import load_robot
from hsr8.world.truth.truth import ActivePush

TRUE = (1.0, -0.5, 0.7)
speeds = st.floats(-0.5, 0.5)


def integrated(start, velocity, time):
    """Pose after a constant velocity in the robot frame, in small steps."""
    x, y, yaw = start
    vx, vy, wz = velocity
    n = 20000
    yaws = yaw + wz * time * (np.arange(n) + 0.5) / n
    x += time / n * np.sum(np.cos(yaws) * vx - np.sin(yaws) * vy)
    y += time / n * np.sum(np.sin(yaws) * vx + np.cos(yaws) * vy)
    return np.array([x, y, yaw + wz * time])


@given(speeds, speeds, st.floats(-2.0, 2.0), st.floats(-3.0, 3.0))
def test_the_velocity_of_an_arc_is_recovered(vx, vy, wz, yaw):
    start = np.array([0.3, -1.0, yaw])
    end = integrated(start, (vx, vy, wz), 0.7)
    assert mean_velocity(start, end, 0.7) == pytest.approx([vx, vy, wz], abs=1e-6)


@pytest.fixture
def frame(fake, tables_of):
    """Frames of a robot that believes to be where it truly is, and of one that drifted."""
    drifted = fake.record(0.02, (0.2, 0.1, -0.4), robot=np.array(TRUE))
    return WorldFrame(tables_of([fake.record(0.0, TRUE), drifted])["records"])


def test_the_pose_in_odometry_becomes_the_true_pose(frame):
    points = np.array([TRUE[:2], (0.2, 0.1)])
    assert frame.point(points) == pytest.approx(np.array([TRUE[:2], TRUE[:2]]))
    assert frame.turn == pytest.approx([0.0, TRUE[2] + 0.4])


def test_distances_and_directions_turn_with_the_robot(frame):
    ahead = np.array([np.cos(-0.4), np.sin(-0.4)])
    begin, end = frame.point(np.array([[(0.0, 0.0), ahead]] * 2)).swapaxes(0, 1)
    assert (end - begin)[1] == pytest.approx([np.cos(TRUE[2]), np.sin(TRUE[2])])
    assert frame.vector(np.array([ahead, ahead])) == pytest.approx(end - begin)


def test_points_of_chosen_rows_are_transformed_with_these_rows(frame):
    rows = np.array([1, 0, 1])
    points = np.array([(0.2, 0.1), TRUE[:2], (0.2, 0.1)])
    assert frame.point(points, rows) == pytest.approx(np.array([TRUE[:2]] * 3))


@pytest.fixture(scope="module")
def records(fake, tables_of):
    """Three records: drifted odometry, an airborne robot, two pushes."""
    force, point = np.array([3.0, 4.0, 0.0]), np.array([1.0, 2.0, 0.3])
    first = ActivePush(0, 0.01, 0.05, "torso_link", 0.0, point, force)
    second = ActivePush(1, 0.035, 0.1, "torso_link", 0.0, 2.0 * point, -force)
    return tables_of(
        [
            fake.record(0.0, (0.2, 0.1, -0.4), robot=np.array(TRUE)),
            fake.record(0.02, TRUE, foot_force=np.zeros(2), pushes=(first,)),
            fake.record(0.04, TRUE, pushes=(first, second)),
        ]
    )["records"]


def test_points_in_odometry_are_at_the_true_robot(records):
    walk = walk_of(records, load_robot("hsr8").model)
    for points in (walk.zmp, walk.com, walk.dcm, walk.feet[..., :2].mean(axis=1)):
        assert points == pytest.approx(np.array([TRUE[:2]] * 3))
    assert walk.feet[..., 3] == pytest.approx(TRUE[2])


def test_an_airborne_robot_has_no_centre_of_pressure(records):
    assert np.isnan(loaded_cop(records)[:, 0]).tolist() == [False, True, False]


def test_a_push_begins_in_its_first_row(records):
    first, second = pushes_of(records)
    assert (first.row, second.row) == (1, 2)
    assert (first.begin, second.begin) == (0.01, 0.035)
    assert (first.impulse, second.impulse) == pytest.approx((0.25, 0.5))
    assert second.point.tolist() == [2.0, 4.0, 0.6]
    assert second.force.tolist() == [-3.0, -4.0, 0.0]


@pytest.mark.parametrize("speed", [0.2, -0.1])
def test_the_velocity_over_every_stride_is_that_of_a_straight_walk(fake, tables_of, speed):
    walked = [fake.record(0.02 * k, (speed * 0.02 * k, 0.0, 0.0)) for k in range(200)]
    table = tables_of(walked)["records"]
    halves = table.rows(0, 70), table.rows(70, 200)
    meter = Speedometer()
    measured = [*meter.add(halves[0]), *meter.add(halves[1])]
    assert [time for time, _ in measured] == [time for time, _ in Speedometer().add(table)]
    assert np.array([v for _, v in measured]) == pytest.approx(
        np.tile([speed, 0.0, 0.0], (len(measured), 1)), abs=1e-9
    )
    whole = strides(table, np.zeros(200, dtype=bool), 0.5)
    steps = table["step_count"]
    assert whole
    assert all(steps[b] - steps[a] == 2 for a, b in whole)
    assert all(a == b for (_, a), (b, _) in pairwise(whole))


lengths = st.floats(1e-3, 3.0)


@given(a=lengths, b=lengths, turn=st.floats(-1.5, 1.5))
def test_the_axes_reproduce_the_covariance(a, b, turn):
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, -s], [s, c]])
    covariance = rotation @ np.diag([a * a, b * b]) @ rotation.T
    half, direction = ellipse_axes(covariance[None])
    assert half[0, 0] >= half[0, 1]
    c, s = np.cos(direction[0]), np.sin(direction[0])
    back = np.array([[c, -s], [s, c]])
    np.testing.assert_allclose(back @ np.diag(half[0] ** 2) @ back.T, covariance, atol=1e-9)


def test_no_covariance_gives_no_ellipse():
    half, direction = ellipse_axes(np.zeros((0, 2, 2)))
    assert half.shape == (0, 2)
    assert direction.shape == (0,)
