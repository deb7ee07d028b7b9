"""The plan seen from the odometry frame: a rigid motion that puts the support foot in its place."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from walking import published_state_kernel as kernel
from walking.published_state_kernel import frame_of, place, turn

SEEDS = st.integers(0, 10**6)


def draw(seed):
    rng = np.random.default_rng(seed)
    return rng, [tuple(rng.uniform(-1.0, 1.0, 3).tolist()) for _ in range(3)]


@settings(max_examples=30)
@given(SEEDS)
def test_the_planned_foot_is_where_odometry_sees_it(seed):
    _, (planned, foot, odometry) = draw(seed)
    rows = np.array([planned])
    place(frame_of(planned, foot, odometry), rows, 2)
    c, s = np.cos(odometry[2]), np.sin(odometry[2])
    seen = np.array(odometry[:2]) + np.array([[c, -s], [s, c]]) @ foot[:2]
    assert rows[0] == pytest.approx([*seen, odometry[2] + foot[2]])


@settings(max_examples=30)
@given(SEEDS)
def test_distances_stay_and_directions_turn_alike(seed):
    rng, motion = draw(seed)
    frame, rows = frame_of(*motion), rng.uniform(-1.0, 1.0, (4, 3))
    before = rows.copy()
    place(frame, rows, -1)
    np.testing.assert_array_equal(rows[:, 2], before[:, 2])
    ways, wanted = np.diff(rows[:, :2], axis=0), np.diff(before[:, :2], axis=0)
    np.testing.assert_allclose(ways, [turn(frame, tuple(way)) for way in wanted.tolist()])
    np.testing.assert_allclose(np.linalg.norm(ways, axis=1), np.linalg.norm(wanted, axis=1))


@settings(max_examples=30)
@given(SEEDS, st.integers(-1, 3))
def test_compiled_it_is_what_it_says(plainly, seed, yaw):
    rng, motion = draw(seed)
    rows, vector, outcomes = rng.uniform(-1.0, 1.0, (3, 4)), (0.3, -0.2), []
    for call in (
        lambda name, *a: getattr(kernel, name)(*a),
        lambda name, *a: plainly(kernel, name, *a),
    ):
        own, frame = rows.copy(), call("frame_of", *motion)
        call("place", frame, own, yaw)
        outcomes.append((frame, own.tolist(), call("turn", frame, vector)))
    assert outcomes[0] == outcomes[1]


@settings(max_examples=30)
@given(SEEDS, st.integers(4, 8))
def test_all_that_a_snapshot_shows_is_brought_over_alike(plainly, seed, corners):
    rng, motion = draw(seed)
    pendulum, error, com = (tuple(rng.uniform(-1.0, 1.0, n).tolist()) for n in (6, 4, 3))
    edges, references = rng.uniform(-1.0, 1.0, (corners, 5)), rng.uniform(-1.0, 1.0, (2, 10))
    planned, way, omega, outcomes = rng.uniform(-1.0, 1.0, (5, 4)), (0.3, -0.2), 7.2, []
    for call in (
        kernel.show,
        lambda *a: plainly(kernel, "show", *a),
    ):
        own = np.empty((5 + corners, 2)), np.empty((2, 4)), planned.copy()
        turned = call(*motion, pendulum, error, omega, com, edges, references, way, *own)
        outcomes.append((turned, *(table.tolist() for table in own)))
    assert outcomes[0] == outcomes[1]
    frame, now, off = frame_of(*motion), np.array(pendulum), np.array(error)
    body = now[:4] + off
    dcm, felt = now[:2] + now[2:4] / omega, body[:2] + body[2:] / omega
    points = np.array([now[4:], dcm, now[:2], felt, *np.roll(edges[:, :2], -1, axis=0)])
    feet = references[:, [0, 1, 3, 2]]
    for table, yaw in ((points, -1), (feet, 3), (planned, 2)):
        place(frame, table, yaw)
    assert own[0][[0, 1, 2, 3, *range(5, 5 + corners)]] == pytest.approx(points)
    seen = complex(*motion[2][:2]) + np.exp(1j * motion[2][2]) * complex(*com[:2])
    assert complex(*own[0][4]) == pytest.approx(seen)
    np.testing.assert_array_equal(own[1], feet)
    np.testing.assert_array_equal(own[2], planned)
    assert turned == turn(frame, way)


@given(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))
def test_a_trunk_is_turned_about_its_axes(plainly, roll, pitch):
    result, plain = np.empty((3, 3)), np.empty((3, 3))
    kernel.incline(roll, pitch, result)
    plainly(kernel, "incline", roll, pitch, plain)
    np.testing.assert_allclose(result, plain, atol=1e-15)
    expected = Rotation.from_euler("YX", [pitch, roll]).as_matrix()
    np.testing.assert_allclose(result, expected, atol=1e-15)
