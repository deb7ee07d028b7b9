"""The pendulum follows its reference with the ZMP in the sole."""

import numpy as np
import pytest

from walking.body.robot_model import Sole
from walking.parameters import PatternParameters
from walking.pattern.generator import make_generator
from walking.pattern.lipm import Lipm
from walking.pattern.pattern import PendulumState, dcm_reference
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import support_region
from walking.state import Footstep

LIPM = Lipm(0.19)
SOLE = Sole(centre=0.01, half_length=0.0525, half_width=0.03)
LEFT, RIGHT = Footstep(True, 0.0, 0.042, 0.0), Footstep(False, 0.0, -0.042, 0.0)
FEET = (RIGHT, LEFT)
BOTH = support_region(SOLE, RIGHT, LEFT, 0.005)
GENERATORS = ["dcm", "preview"]


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


@pytest.mark.parametrize("name", GENERATORS)
def test_a_displaced_pendulum_comes_to_rest_over_the_reference(name):
    generator = make_generator(LIPM, PatternParameters(generator=name), SOLE)
    state = PendulumState(0.02, 0.01, 0.0, 0.05, 0.02, 0.01)
    ramps = [ZmpRamp(1, 0.01, 0.0, 0.01, 0.0, FEET)]
    for _ in range(400):
        generator.advance(state, ramps, BOTH)
        assert BOTH.clip(state.zmp_x, state.zmp_y) == (state.zmp_x, state.zmp_y)
    np.testing.assert_allclose(
        [state.x, state.y, state.vx, state.vy], [0.01, 0.0, 0.0, 0.0], atol=2e-4
    )


@pytest.mark.parametrize("name", GENERATORS)
def test_the_zmp_tracks_a_sideways_shift(name):
    generator = make_generator(LIPM, PatternParameters(generator=name), SOLE)
    state = PendulumState(0.01, 0.0, zmp_x=0.01)
    region = BOTH
    for k in range(60):
        left = max(1, 60 - k)
        here = 0.03 * min(1.0, k / 60)
        ramps = [
            ZmpRamp(left, 0.01, here, 0.01, 0.03, FEET),
            ZmpRamp(200, 0.01, 0.03, 0.01, 0.03, FEET),
        ]
        generator.advance(state, ramps, region)
    assert state.y + state.vy / LIPM.omega == pytest.approx(0.03, abs=6e-3)


@pytest.mark.parametrize("name", GENERATORS)
def test_generators_mirror(name):
    states = []
    for sign in (1.0, -1.0):
        generator = make_generator(LIPM, PatternParameters(generator=name), SOLE)
        state = PendulumState(0.0, sign * 0.01, 0.1, sign * 0.02, 0.0, sign * 0.01)
        ramps = [ZmpRamp(r.ticks, r.ax, sign * r.ay, r.bx, sign * r.by, FEET) for r in RAMPS]
        generator.advance(state, ramps, BOTH)
        states.append((state.x, sign * state.y, state.zmp_x, sign * state.zmp_y))
    assert states[0] == pytest.approx(states[1], abs=1e-12)
