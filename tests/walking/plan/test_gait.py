"""Clock, feet and ZMP reference of the gait."""

from itertools import pairwise

import numpy as np
import pytest

from walking.constants import parameters_record
from walking.data import SingleSupport, Timing
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.plan.footsteps import STILL, foothold, is_parallel, landing_of, put
from walking.plan.gait import (
    advance,
    aimed,
    end_support,
    is_adjustable,
    is_double,
    phase_of,
    retime,
    right_weight,
    scheduled_zmp,
    shorten,
    start,
    support_foot,
    swing_of,
    touch_down,
)
from walking.plan.reference import plan_walk
from walking.plan.steering import follow_command, moves, set_wanted_strides, use_next_timing
from walking.plan.timing import put_single_support, put_timing, retime_single_support, swing_phase

PARAMETERS = WalkingParameters()
GAIT, LIMITS = PARAMETERS.gait, PARAMETERS.limits
RECORD = parameters_record(PARAMETERS)[0]
FORWARD, SLOWER = (0.2, 0.0, 0.0), (0.1, 0.0, 0.0)
START = round(GAIT.start_time / CONTROL_PERIOD)
STEP = round(GAIT.footstep_time / CONTROL_PERIOD)
MIN_TICKS = round(GAIT.min_swing_time / CONTROL_PERIOD)


class Walk:
    """Gait that follows strides without a pendulum."""

    def __init__(self, model, strides_of, make_walk):
        self.model, self.strides_of = model, strides_of
        self.walk = make_walk()
        self.plan = self.walk.plan
        self.gait, self.feet = self.plan.gait, self.walk.limbs.feet

    def start(self, support=0):
        start(self.gait, support, False, self.model.robot)
        return self

    def tick(self, velocity=STILL, *, strides=None, moving=True):
        gait, model = self.gait, self.model
        strides = self.strides_of(velocity) if strides is None else strides
        if is_adjustable(gait, model.robot):
            wanted = landing_of(support_foot(gait), strides)
            put(gait.landing, aimed(gait, self.landing, wanted, model.robot))
        plan_walk(self.plan, self.landing, strides, moving, model.robot)
        ramps = self.plan.ramps[: self.plan.ramp_count].copy()
        advance(self.plan, self.feet, model.robot)
        return ramps

    def swing_to(self, phase, velocity=FORWARD):
        while phase_of(self.gait).swing < phase:
            self.tick(velocity)
        return self

    def retime(self, double, single, height=0.025):
        timing = np.zeros(1, Timing)[0]
        put_timing(timing, (double, single, height))
        return retime(self.gait, timing, self.model.robot)

    def shorten(self, ticks, landing):
        return shorten(self.gait, self.feet, ticks, landing, self.model.robot)

    @property
    def landing(self):
        return foothold(self.gait.landing)

    @property
    def swing(self):
        return self.feet[swing_of(self.gait)]


@pytest.fixture
def walk(model, strides_of, make_walk):
    return Walk(model, strides_of, make_walk)


def single_support(ticks):
    single = np.zeros(1, SingleSupport)[0]
    put_single_support(single, ticks, RECORD)
    return single


@pytest.mark.parametrize("ticks", [1, 35, 60, 90])
@pytest.mark.parametrize("elapsed", [2, 20, 30])
def test_a_swing_retimed_goes_on_from_its_phase_and_has_time_to_come_down(elapsed, ticks):
    single = single_support(60)
    phase = swing_phase(single, elapsed)
    retime_single_support(single, elapsed, ticks, RECORD)
    assert swing_phase(single, elapsed) == phase
    assert swing_phase(single, single.last) == 1.0
    assert single.last >= elapsed + MIN_TICKS
    assert single.ticks == ticks or single.last == elapsed + MIN_TICKS


def test_a_footstep_takes_the_footstep_time_and_lands_as_planned(walk):
    walk.start()
    gait, landings = walk.gait, []
    for k in range(START + 6 * STEP):
        before = gait.completed
        walk.tick(FORWARD)
        if gait.completed > before:
            landings.append((k, float(gait.footholds[gait.support].x)))
    assert all(b[0] - a[0] == STEP for a, b in pairwise(landings))
    stride = FORWARD[0] * GAIT.footstep_time
    assert all(b[1] - a[1] == pytest.approx(stride) for a, b in pairwise(landings[1:]))


def test_feet_move_without_jumps_and_only_in_the_air(walk):
    walk.start(1)
    rows = []
    for _ in range(START + 4 * STEP):
        walk.tick(FORWARD)
        rows.append([*walk.feet["x"], *walk.feet["height"]])
    path = np.array(rows)
    assert np.abs(np.diff(path[:, :2], axis=0)).max() < 0.02
    for side in range(2):
        height = path[:, 2 + side]
        assert height.max() == pytest.approx(GAIT.swing_height, rel=0.01)
        moved = np.abs(np.diff(path[:, side])) > 1e-3
        assert (height[1:][moved] > 0.0).all()


def test_the_landing_may_change_in_the_air_until_it_is_frozen(walk):
    walk.start().swing_to(0.5)
    planned = walk.landing.x
    while is_adjustable(walk.gait, walk.model.robot):
        walk.tick(SLOWER)
    assert walk.landing.x < planned - 0.02
    frozen = walk.landing
    while walk.gait.completed == 0:
        walk.tick(FORWARD)
    assert foothold(walk.gait.footholds[1]) == frozen


def test_a_support_that_ends_at_an_early_contact_begins_the_next_footstep(walk):
    walk.start().swing_to(0.7)
    touch_down(walk.gait, walk.feet, walk.model.robot)
    end_support(walk.gait)
    walk.tick(FORWARD)
    assert walk.gait.completed == 1
    assert is_double(walk.gait)
    assert walk.gait.support == 1


@pytest.mark.parametrize("lead", [2, 20, 40])
def test_a_shortened_footstep_lands_in_time_and_the_next_has_the_usual_time(walk, lead):
    walk.start()
    for _ in range(START + STEP - round(GAIT.double_support * STEP) + lead):
        walk.tick(FORWARD)
    gait, completed, foot, lift = walk.gait, walk.gait.completed, walk.swing, []
    assert walk.shorten(5, walk.landing)
    assert gait.shortened
    left = phase_of(gait).ticks_left
    assert left <= STEP - lead - 10
    while gait.completed == completed:
        swing, landing = swing_of(gait), walk.landing
        walk.tick(FORWARD)
        lift.append(float(foot.height))
        retime(gait, gait.clock.timing, walk.model.robot)
    assert len(lift) == left
    assert lift[-1] == pytest.approx(0.0, abs=1e-9)
    assert foothold(gait.footholds[swing]) == landing
    assert np.abs(np.diff(lift)).max() < 0.01
    assert not gait.shortened
    assert phase_of(gait).ticks_left == STEP


def test_shortening_delays_no_footstep_and_respects_the_swing_speed(walk):
    walk.start()
    for _ in range(START + STEP):
        walk.tick(FORWARD)
    gait, before, landing = walk.gait, phase_of(walk.gait).ticks_left, walk.landing
    assert not walk.shorten(int(before) + 5, landing)
    assert phase_of(gait).ticks_left == before
    far = landing._replace(x=landing.x + 0.2)
    assert walk.shorten(0, far)
    distance = far.x - walk.swing.x
    assert phase_of(gait).ticks_left * CONTROL_PERIOD >= 1.875 * distance / GAIT.swing_speed


@pytest.mark.parametrize("single", [40, 90])
@pytest.mark.parametrize("phase", [0.1, 0.4, 0.7])
def test_single_support_stretched_or_cut_in_mid_swing_keeps_the_foot_smooth(walk, single, phase):
    walk.start().swing_to(phase, STILL)
    heights, held = [float(walk.feet[1].height)], phase_of(walk.gait).swing
    walk.retime(14, single)
    assert phase_of(walk.gait).swing == held
    while walk.gait.completed == 0:
        walk.tick()
        heights.append(float(walk.feet[1].height))
    assert np.abs(np.diff(heights)).max() < 0.008
    assert heights[-1] == 0.0


def test_a_double_support_under_way_changes_its_length(walk):
    walk.start()
    gait, model = walk.gait, walk.model
    while gait.completed == 0:
        walk.tick()
    for _ in range(5):
        walk.tick()
    weight, zmp = right_weight(gait), scheduled_zmp(gait, model.robot)
    assert walk.retime(30, 54)
    assert right_weight(gait) == pytest.approx(weight)
    assert scheduled_zmp(gait, model.robot) == pytest.approx(zmp)
    for _ in range(25):
        assert is_double(gait)
        walk.tick()
    assert not is_double(gait)


def stop(walk, velocity, stop_at):
    """Footsteps completed between the command to stop and the time of standing."""
    model, steering, timing = walk.model, walk.walk.steering, np.zeros(1, Timing)[0]
    walk.start()
    for tick in range(stop_at + 400):
        steering.command.velocity = velocity if tick < stop_at else STILL
        if tick == stop_at:
            completed = int(walk.gait.completed)
        follow_command(steering, 1.0, True, True, model.robot)
        use_next_timing(timing, steering, walk.gait.clock.timing, walk.gait.stepping)
        retime(walk.gait, timing, model.robot)
        set_wanted_strides(steering, STILL, model.robot)
        walk.tick(strides=steering.wanted, moving=moves(steering))
        if tick >= stop_at and not walk.gait.stepping:
            break
    left, right = (foothold(foot) for foot in walk.gait.footholds)
    assert is_parallel(left, right, model.robot)
    return walk.gait.completed - completed


@pytest.mark.parametrize(
    ("velocity", "generator"),
    [
        ((-LIMITS.vx_backward, 0.0, 0.0), "preview"),
        ((0.0, LIMITS.vy, 0.0), "preview"),
        ((0.4, -0.1, 0.8), "preview"),
        ((0.4, -0.1, 0.8), "mwpg"),
    ],
)
def test_two_footsteps_stop_the_fastest_walk_from_any_phase(
    make_model, strides_of, make_walk, velocity, generator
):
    model = make_model(generator)
    for stop_at in range(264, 400, 45):
        # The footstep under way when the command comes is finished first.
        assert stop(Walk(model, strides_of, make_walk), velocity, stop_at) <= 3


def test_a_foot_on_the_floor_comes_down_to_it_and_stays(walk):
    decay = float(walk.model.robot.stabilizer.contact_decay)
    walk.feet["height"], before = 0.1, walk.feet["x"].copy()
    walk.tick()
    assert walk.feet["height"].tolist() == pytest.approx([0.1 * decay, 0.1 * decay])
    assert walk.feet["x"].tolist() == before.tolist()
