"""The gait's clock, feet and ZMP reference."""

from itertools import pairwise

import numpy as np
import pytest

from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.stride import STILL, Timing
from walking.gait.gait import Gait
from walking.gait.swing_foot_kernel import HEIGHT
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.phase import Phase

PARAMETERS = WalkingParameters()
GAIT = PARAMETERS.gait
FORWARD, SLOWER = (0.2, 0.0, 0.0), (0.1, 0.0, 0.0)
START = round(GAIT.start_time / CONTROL_PERIOD)
STEP = round(GAIT.footstep_time / CONTROL_PERIOD)


SOLE = Sole(centre=0.01, half_length=0.0525, half_width=0.03)
PLANNER = FootstepPlanner(GAIT, PARAMETERS.limits, SOLE)


@pytest.fixture
def gait():
    h = GAIT.half_stance
    return Gait(
        PARAMETERS, PLANNER, (Foothold(True, 0.0, h, 0.0), Foothold(False, 0.0, -h, 0.0)), SOLE
    )


def tick(gait, velocity, *, moving=True):
    strides = PLANNER.strides(velocity, GAIT.footstep_time)
    if gait.adjustable:
        gait.aim(gait.nominal(strides))
    ramps = gait.plan(gait.landing, strides, moving=moving)
    gait.advance(moving=moving)
    return ramps


def test_phases_follow_each_other(gait):
    gait.start(0)
    phases = []
    for _ in range(START + 4 * STEP):
        if not phases or phases[-1] is not gait.phase:
            phases.append(gait.phase)
        tick(gait, FORWARD)
    assert phases[:5] == [
        Phase.DOUBLE_SUPPORT,
        Phase.LEFT_SUPPORT,
        Phase.DOUBLE_SUPPORT,
        Phase.RIGHT_SUPPORT,
        Phase.DOUBLE_SUPPORT,
    ]


def test_a_footstep_takes_the_footstep_time_and_lands_as_planned(gait):
    gait.start(0)
    landings = []
    for k in range(START + 6 * STEP):
        before = gait.completed
        tick(gait, FORWARD)
        if gait.completed > before:
            landings.append((k, gait.footholds[1 - gait.support].x, gait.footholds[gait.support].x))
    assert all(b[0] - a[0] == STEP for a, b in pairwise(landings))
    stride = FORWARD[0] * GAIT.footstep_time
    assert all(b[2] - a[2] == pytest.approx(stride) for a, b in pairwise(landings[1:]))


def test_feet_move_without_jumps_and_only_in_the_air(gait):
    gait.start(1)
    rows = []
    for _ in range(START + 4 * STEP):
        tick(gait, FORWARD)
        rows.append(gait.feet[:, [0, HEIGHT]].ravel())
    path = np.array(rows)
    assert np.abs(np.diff(path[:, [0, 2]], axis=0)).max() < 0.02
    for x, height in ((0, 1), (2, 3)):
        assert path[:, height].max() == pytest.approx(GAIT.swing_height, rel=0.01)
        moved = np.abs(np.diff(path[:, x])) > 1e-3
        assert (path[1:, height][moved] > 0.0).all()


def test_the_zmp_reference_is_continuous_and_ends_between_the_feet(gait):
    gait.start(0)
    for k in range(START + 5 * STEP):
        ramps = tick(gait, FORWARD, moving=k < 300)
        for a, b in pairwise(ramps):
            assert (a.bx, a.by) == pytest.approx((b.ax, b.ay))
    for _ in range(3 * STEP):
        ramps = tick(gait, STILL, moving=False)
    assert gait.phase is Phase.STANDING
    left, right = gait.footholds
    assert ramps[-1].by == pytest.approx(0.5 * (left.y + right.y))
    assert left.x == pytest.approx(right.x)


def test_the_landing_may_change_in_the_air_until_it_is_frozen(gait):
    gait.start(0)
    while gait.swing_phase < 0.5:
        tick(gait, FORWARD)
    planned = gait.landing.x
    while gait.adjustable:
        tick(gait, SLOWER)
    assert gait.landing.x < planned - 0.02
    frozen = gait.landing
    while gait.completed == 0:
        tick(gait, FORWARD)
    assert gait.footholds[1] == frozen


def test_early_contact_leaves_the_foot_where_it_is(gait):
    gait.start(0)
    while gait.swing_phase < 0.7:
        tick(gait, FORWARD)
    x, height = gait.feet[1, [0, HEIGHT]].tolist()
    gait.touchdown()
    while gait.completed == 0:
        tick(gait, FORWARD)
    assert gait.footholds[1].x == pytest.approx(x)
    assert 0.0 < gait.feet[1, HEIGHT] < height


@pytest.mark.parametrize("lead", [2, 20, 40])
def test_a_shortened_footstep_lands_in_time_and_the_next_has_the_usual_time(gait, lead):
    gait.start(0)
    for _ in range(START + STEP - round(GAIT.double_support * STEP) + lead):
        tick(gait, FORWARD)
    completed, foot, lift = gait.completed, gait.feet[gait.swing], []
    assert gait.shorten(5, gait.landing)
    assert gait.shortened
    left = gait.ticks_left
    assert left <= STEP - lead - 10
    while gait.completed == completed:
        swing, landing = gait.swing, gait.landing
        tick(gait, FORWARD)
        lift.append(float(foot[HEIGHT]))
        gait.retime(gait.timing)
    assert len(lift) == left
    assert lift[-1] == pytest.approx(0.0, abs=1e-9)
    assert gait.footholds[swing] == landing
    assert np.abs(np.diff(lift)).max() < 0.01
    assert not gait.shortened
    assert gait.ticks_left == STEP


def test_shorten_never_delays_a_footstep(gait):
    gait.start(0)
    for _ in range(START + STEP):
        tick(gait, FORWARD)
    before = gait.ticks_left
    assert not gait.shorten(before + 5, gait.landing)
    assert gait.ticks_left == before


def test_a_shortened_footstep_respects_the_swing_speed(gait):
    gait.start(0)
    for _ in range(START + STEP):
        tick(gait, FORWARD)
    landing = gait.landing
    far = Foothold(landing.left, landing.x + 0.2, landing.y, landing.yaw)
    assert gait.shorten(0, far)
    distance = far.x - gait.feet[gait.swing, 0]
    assert gait.ticks_left * CONTROL_PERIOD >= 1.875 * distance / GAIT.swing_speed


def test_the_cached_reference_of_a_tick_equals_a_new_one(gait):
    gait.start(0)
    wishes = [PLANNER.strides(velocity, GAIT.footstep_time) for velocity in (FORWARD, SLOWER)]
    for k in range(START + 3 * STEP):
        wish = wishes[k // 50 % 2]
        result = gait.plan(gait.landing, wish, moving=True)
        gait.plan(gait.landing, PLANNER.still, moving=True)  # drops the cache
        anew = gait.plan(gait.landing, wish, moving=True)
        np.testing.assert_array_equal(result.table, anew.table)
        tick(gait, (FORWARD, SLOWER)[k // 50 % 2])


@pytest.mark.parametrize("single", [40, 90])
@pytest.mark.parametrize("phase", [0.1, 0.4, 0.7])
def test_single_support_stretched_or_cut_in_mid_swing_keeps_the_foot_smooth(gait, single, phase):
    gait.start(0)
    while gait.swing_phase < phase:
        tick(gait, STILL)
    heights, held = [float(gait.feet[1, HEIGHT])], gait.swing_phase
    gait.retime(Timing(14, single, 0.025))
    assert gait.swing_phase == held
    while gait.completed == 0:
        tick(gait, STILL)
        heights.append(float(gait.feet[1, HEIGHT]))
    assert np.abs(np.diff(heights)).max() < 0.008
    assert heights[-1] == 0.0


def test_a_frozen_landing_keeps_its_time(gait):
    gait.start(0)
    while gait.swing_phase < 0.85:
        tick(gait, STILL)
    left = gait.ticks_left
    assert not gait.retime(Timing(14, 100, 0.025))
    assert gait.ticks_left == left


def test_a_double_support_under_way_changes_its_length(gait):
    gait.start(0)
    while gait.completed == 0:
        tick(gait, STILL)
    for _ in range(5):
        tick(gait, STILL)
    weight, origin = gait.right_weight, gait.zmp
    assert gait.retime(Timing(30, 54, 0.025))
    assert gait.right_weight == pytest.approx(weight)
    assert gait.zmp == pytest.approx(origin)
    for _ in range(25):
        assert gait.double
        tick(gait, STILL)
    assert not gait.double
