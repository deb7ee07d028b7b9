from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.render.motion import motion_of, rows_at

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
