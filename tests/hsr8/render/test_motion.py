from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.recorder.derived import Push
from hsr8.render.motion import GAP, SHOWN, Motion, arrows_at, motion_of, push_arrows, rows_at

TIMES = st.lists(st.integers(0, 200), min_size=1, max_size=20, unique=True).map(sorted)


def test_movers_are_the_last_obstacles(fake, tables_of, layout):
    records = tables_of([fake.record(time) for time in (0.0, 0.5, 1.0)])["records"]
    motion = motion_of(SimpleNamespace(records=records), 1)
    assert len(motion) == 3
    assert motion.qpos.shape == (3, 33)
    (mover,) = (obstacle.motion for obstacle in layout.obstacles if obstacle.motion)
    places = [mover.position(time) for time in motion.time]
    assert motion.movers[:, 0] == pytest.approx(np.array(places))
    assert motion_of(SimpleNamespace(records=records), 0).movers.shape == (3, 0, 2)


@given(TIMES, st.integers(-5, 205))
def test_the_row_at_a_time_is_the_last_one_before_it(ticks, wanted):
    time = 0.02 * np.array(ticks)
    (row,) = rows_at(time, [0.02 * wanted]).tolist()
    earlier = [k for k, tick in enumerate(ticks) if tick <= wanted]
    assert row == (earlier[-1] if earlier else 0)


@pytest.fixture
def run():
    """Two pushes that follow at once, the robot being 1 m up along x."""
    point = np.array([1.0, 0.0, 0.3])
    pushes = (
        Push(10, 0.19, 0.5, point, np.array([10.0, 0.0, 0.0])),
        Push(13, 0.245, 0.2, point, np.array([0.0, -5.0, 0.0])),
    )
    qpos = np.zeros((100, 33))
    qpos[:, 0] = 1.0
    return pushes, Motion(0.02 * np.arange(100), qpos, np.zeros((100, 0, 2)))


def test_arrows_end_before_the_point_of_the_force(run):
    first, second = push_arrows(*run)
    assert (first.begin, second.begin) == pytest.approx((0.19, 0.245))
    assert (first.impulse, second.impulse) == pytest.approx((0.5, 0.2))
    assert first.tip == pytest.approx([-GAP, 0.0, 0.3])
    assert second.tip == pytest.approx([0.0, GAP, 0.3])


def test_an_arrow_moves_with_the_robot_and_disappears(run):
    pushes = push_arrows(*run)[:1]
    base = np.array([1.5, 0.2, 0.0])
    ((tail, tip),) = arrows_at(pushes, 0.3, base, 1.0)
    assert tip == pytest.approx(base + np.array([-GAP, 0.0, 0.3]))
    assert tip - tail == pytest.approx([0.2, 0.0, 0.0])
    assert arrows_at(pushes, 0.17, base, 1.0) == []
    assert arrows_at(pushes, 0.195 + SHOWN, base, 1.0) == []
    assert len(arrows_at(pushes, 0.19 + SHOWN, base, 2.0)) == 1
