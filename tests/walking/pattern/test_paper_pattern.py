"""ZMP functions that lead the pendulum to a walking state."""

from math import exp

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.parameters import CONTROL_PERIOD, PatternParameters
from walking.pattern.dcm_pattern import dcm_reference
from walking.pattern.lipm import Lipm
from walking.pattern.paper_pattern import PaperGenerator, zmp_function
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import support_region

LIPM = Lipm(0.19)
W = LIPM.omega
SOLE = Sole(centre=0.01, half_length=0.0525, half_width=0.03)
times = st.floats(0.02, 0.5)


def integrals(function, time):
    """A and B of a two-level function."""
    z, growth = exp(W * function.switch), exp(W * time)
    level = function.level
    return level * (growth + 1.0 - 2.0 * z), level * (2.0 / z - 1.0 / growth - 1.0)


@given(times, st.floats(-0.2, 0.2), st.floats(-0.05, 0.05))
def test_the_function_integrates_to_what_is_wanted(time, a, b):
    function = zmp_function(W, time, a, b)
    assert 0.0 <= function.switch <= time + 1e-12
    assert integrals(function, time) == pytest.approx((a, b), abs=1e-7)


@given(times, st.floats(-0.03, 0.03), st.floats(0.0, 1.0), st.floats(-1.0, 1.0))
def test_no_other_two_level_function_has_a_lower_peak(time, first, fraction, ratio):
    """The function is the admissible one wherever any function is."""
    second, growth = first * ratio, exp(W * time)
    z = exp(W * (1.0 - fraction) * time)
    a = first * (growth - z) + second * (z - 1.0)
    b = first * (1.0 / z - 1.0 / growth) + second * (1.0 - 1.0 / z)
    assert abs(zmp_function(W, time, a, b).level) <= max(abs(first), abs(second)) + 1e-9


def feet(count=5, stride=0.05):
    steps = [Foothold(True, 0.0, 0.042, 0.0)]
    for k in range(1, count):
        left = k % 2 == 0
        steps.append(Foothold(left, k * stride, 0.042 if left else -0.042, 0.0))
    return steps


def reference(steps, left):
    """Ramps with `left` ticks of the first single support to go."""
    points = [(f.x + 0.01, f.y) for f in steps]
    ramps = [ZmpRamp(left, *points[0], *points[0], (steps[0], steps[0]))]
    for k in range(1, len(steps)):
        ramps.append(ZmpRamp(14, *points[k - 1], *points[k], (steps[k - 1], steps[k])))
        ramps.append(ZmpRamp(54, *points[k], *points[k], (steps[k], steps[k])))
    return ramps


def start_of_support(stride=0.05):
    """A pendulum in periodic walking at the start of single support."""
    steps = feet(9, stride)
    generator = PaperGenerator(LIPM, PatternParameters())
    target = generator.walking_target(reference(steps, 54))
    growth = exp(W * 54 * CONTROL_PERIOD)
    # Under a ZMP at rest ζ only decays.
    zeta = [growth * z for z in target.zeta]
    x, y = dcm_reference(LIPM, reference(steps, 54))
    dx, dy = x - 0.01, y - 0.042
    return PendulumState(
        0.01 + 0.5 * (dx + zeta[0]),
        0.042 + 0.5 * (dy + zeta[1]),
        0.5 * W * (dx - zeta[0]),
        0.5 * W * (dy - zeta[1]),
    )


def run(generator, state, steps, ticks, change=None):
    region = support_region(SOLE, steps[0], steps[0], 0.005)
    path = []
    for k in range(ticks):
        if change is not None and k == change[0]:
            steps = change[1]
        ramps = reference(steps, 54 - k)
        admitted = generator.admits(state, ramps, region)
        generator.advance(state, ramps, region)
        path.append((admitted, state.zmp_x, state.zmp_y))
    return steps, path


def test_a_walk_that_goes_on_as_it_is_needs_no_function():
    state = start_of_support()
    _, path = run(PaperGenerator(LIPM, PatternParameters()), state, feet(9), 54)
    assert all(admitted for admitted, _, _ in path)
    zmp = np.array([row[1:] for row in path])
    np.testing.assert_allclose(zmp, np.tile([0.01, 0.042], (54, 1)), atol=1e-4)


@pytest.mark.parametrize("tick", [0, 10, 25])
@pytest.mark.parametrize("stride", [0.035, 0.065])
def test_position_and_velocity_of_a_new_walk_are_reached_at_touch_down(tick, stride):
    generator = PaperGenerator(LIPM, PatternParameters())
    state = start_of_support()
    steps, path = run(generator, state, feet(9), 54, (tick, feet(9, stride)))
    assert all(admitted for admitted, _, _ in path)
    target = generator.walking_target(reference(steps, 1))
    dx, dy = state.x - 0.01, state.y - 0.042
    xi = (dx + state.vx / W, dy + state.vy / W)
    zeta = (dx - state.vx / W, dy - state.vy / W)
    assert xi == pytest.approx(target.xi, abs=1e-5)
    assert zeta == pytest.approx(target.zeta, abs=1e-5)
    region = support_region(SOLE, feet()[0], feet()[0], 0.005)
    for _, x, y in path:
        assert region.clip(x, y) == (x, y)


def test_a_late_change_is_rejected_and_the_zmp_stays_in_the_sole():
    generator = PaperGenerator(LIPM, PatternParameters())
    state = start_of_support()
    _, path = run(generator, state, feet(9), 54, (48, feet(9, 0.12)))
    assert all(admitted for admitted, _, _ in path[:48])
    assert not path[48][0]
    region = support_region(SOLE, feet()[0], feet()[0], 0.005)
    for _, x, y in path:
        assert region.clip(x, y) == pytest.approx((x, y), abs=1e-12)


def test_the_residual_of_an_infeasible_target_is_reported():
    generator = PaperGenerator(LIPM, PatternParameters())
    state = start_of_support()
    state.vx += 0.4
    ramps = reference(feet(9), 54)
    region = support_region(SOLE, feet()[0], feet()[0], 0.005)
    generator.advance(state, ramps, region)
    own = state.x + state.vx / W
    assert generator.planned_dcm(state, ramps)[0] < own - 0.005
