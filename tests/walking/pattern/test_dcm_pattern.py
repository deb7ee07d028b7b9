"""The DCM of a reference, and the pendulum that tracks it."""

import pytest

from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.pattern.dcm_pattern import DcmGenerator, dcm_reference
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import support_region

LIPM = Lipm(0.19)
FEET = (Foothold(False, 0.0, -0.042, 0.0), Foothold(True, 0.0, 0.042, 0.0))
BOTH = support_region(Sole(centre=0.01, half_length=0.0525, half_width=0.03), *FEET, 0.005)


def shift(ramps, dx, dy):
    return [ZmpRamp(r.ticks, r.ax + dx, r.ay + dy, r.bx + dx, r.by + dy, FEET) for r in ramps]


RAMPS = [
    ZmpRamp(20, 0.0, 0.0, 0.01, 0.03, FEET),
    ZmpRamp(54, 0.01, 0.03, 0.01, 0.03, FEET),
    ZmpRamp(14, 0.01, 0.03, 0.05, -0.03, FEET),
]


def test_dcm_reference_walks_the_reference_exactly():
    x, y = dcm_reference(LIPM, RAMPS)
    for ramp in RAMPS:
        c = LIPM.ramp(ramp.ticks)
        x = c.growth * x - c.first * ramp.ax - c.last * ramp.bx
        y = c.growth * y - c.first * ramp.ay - c.last * ramp.by
    assert (x, y) == pytest.approx((RAMPS[-1].bx, RAMPS[-1].by), abs=1e-9)


def test_dcm_reference_moves_with_the_footholds():
    x, y = dcm_reference(LIPM, RAMPS)
    assert dcm_reference(LIPM, shift(RAMPS, 0.1, -0.2)) == pytest.approx((x + 0.1, y - 0.2))


def test_dcm_reference_forgets_the_far_future():
    far = [*RAMPS, ZmpRamp(300, 0.05, -0.03, 0.05, -0.03, FEET)]
    moved = [*far, ZmpRamp(1, 0.05, -0.03, 5.0, 5.0, FEET)]
    assert dcm_reference(LIPM, moved) == pytest.approx(dcm_reference(LIPM, far), abs=1e-3)


def test_a_pendulum_on_the_dcm_is_walked_along_the_reference():
    x, y = dcm_reference(LIPM, RAMPS)
    state = PendulumState(x, y)
    DcmGenerator(LIPM, 2.0).advance(state, RAMPS, BOTH)
    first, ticks = RAMPS[0], RAMPS[0].ticks
    # Held for a tick, the ZMP is that of the tick's middle.
    assert state.zmp_x == pytest.approx(first.ax + 0.5 / ticks * (first.bx - first.ax))
    left = ZmpRamp(
        ticks - 1,
        first.ax + (first.bx - first.ax) / ticks,
        first.ay + (first.by - first.ay) / ticks,
        *(first.bx, first.by, FEET),
    )
    due = dcm_reference(LIPM, [left, *RAMPS[1:]])
    own = state.x + state.vx / LIPM.omega, state.y + state.vy / LIPM.omega
    assert own == pytest.approx(due, abs=1e-6)


@pytest.mark.parametrize("gain", [1.5, 3.0])
def test_an_error_of_the_dcm_shrinks_by_the_gain(gain):
    w = LIPM.omega
    state = PendulumState(0.012, -0.001, -0.001 * w, 0.002 * w)  # its DCM is off by 1 mm
    DcmGenerator(LIPM, gain).track(state, (0.01, 0.0), (0.01, 0.0), BOTH)
    growth = LIPM.ramp(1).growth
    left = growth - gain * (growth - 1.0)
    assert state.x + state.vx / w - 0.01 == pytest.approx(0.001 * left)
    assert state.y + state.vy / w == pytest.approx(0.001 * left)
