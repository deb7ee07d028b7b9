"""The plan seen from the odometry frame: a rigid motion that puts the support foot in its place."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking import snapshot_kernel
from walking.snapshot_kernel import frame_of, place, turn

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
        lambda name, *a: getattr(snapshot_kernel, name)(*a),
        lambda name, *a: plainly(snapshot_kernel, name, *a),
    ):
        own, frame = rows.copy(), call("frame_of", *motion)
        call("place", frame, own, yaw)
        outcomes.append((frame, own.tolist(), call("turn", frame, vector)))
    assert outcomes[0] == outcomes[1]


@settings(max_examples=30)
@given(SEEDS)
def test_all_that_a_snapshot_shows_is_brought_over_alike(plainly, seed):
    rng, motion = draw(seed)
    tables = [rng.uniform(-1.0, 1.0, shape) for shape in ((8, 2), (2, 4), (5, 4))]
    way, outcomes = (0.3, -0.2), []
    for call in (
        snapshot_kernel.bring_over,
        lambda *a: plainly(snapshot_kernel, "bring_over", *a),
    ):
        own = [table.copy() for table in tables]
        turned = call(*motion, *own, way)
        outcomes.append((turned, *(table.tolist() for table in own)))
    assert outcomes[0] == outcomes[1]
    frame = frame_of(*motion)
    for table, yaw in zip(tables, (-1, 3, 2), strict=True):
        place(frame, table, yaw)
    assert outcomes[0] == (turn(frame, way), *(table.tolist() for table in tables))
