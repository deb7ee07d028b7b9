"""Generators that track any reference, with the ZMP in the sole."""

import numpy as np
import pytest

from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.parameters import PatternParameters
from walking.pattern.generator import make_generator
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import support_region

LIPM = Lipm(0.19)
SOLE = Sole(centre=0.01, half_length=0.0525, half_width=0.03)
LEFT, RIGHT = Foothold(True, 0.0, 0.042, 0.0), Foothold(False, 0.0, -0.042, 0.0)
FEET = (RIGHT, LEFT)
BOTH = support_region(SOLE, RIGHT, LEFT, 0.005)
GENERATORS = ["dcm", "preview"]


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
