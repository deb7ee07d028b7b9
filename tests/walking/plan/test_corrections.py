"""Slow corrections of a body that slips, is off balance, or whose centre of mass differs."""

from itertools import pairwise
from math import cos, exp, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.constants import parameters_record
from walking.data import Corrections
from walking.parameters import CONTROL_PERIOD, StabilizerParameters, WalkingParameters
from walking.plan.corrections import (
    correct_offset,
    cycle_begins,
    detects_touchdown,
    heading_rate,
    restart_cycle,
    speed_correction,
    speed_ratio,
)

LIMITS = StabilizerParameters()
PARAMETERS = parameters_record(WalkingParameters())[0]
CYCLE = 136  # control ticks of two footsteps
slips, offs = st.floats(-0.015, 0.015), st.floats(-0.012, 0.012)


def corrections():
    record = np.zeros(1, Corrections)[0]
    restart_cycle(record)
    return record


@pytest.mark.parametrize("first", [0, 1])
def test_a_cycle_begins_with_every_second_footstep(first):
    record, feet = corrections(), [foot for foot in (first, 1 - first) * 3 for _ in range(10)]
    begun = [tick for tick, foot in enumerate(feet) if cycle_begins(record, foot)]
    assert begun == [0, 20, 40]


def turn(record, ahead, *, renew):
    return heading_rate(record, ahead, renew, PARAMETERS)


def test_a_steady_slip_is_held_although_one_footstep_turns_for_two_and_the_body_sways():
    """The opening foot turns by the rate of that moment for both footsteps."""
    record, plan, slip, settled = corrections(), 0.0, 0.0, []
    for tick in range(30 * CYCLE):
        slip -= 0.05 * CONTROL_PERIOD
        phase = tick % CYCLE
        sway = 0.02 * sin(2.0 * pi * phase / CYCLE)
        rate = turn(record, sway - slip, renew=phase == 0)
        if phase == CYCLE // 4:
            plan += CYCLE * CONTROL_PERIOD * rate
        if phase == CYCLE - 1:
            settled.append(plan + slip)
    assert settled[-1] == pytest.approx(settled[-6], abs=1e-5)


def test_the_yaw_rate_is_constant_over_a_cycle_and_limited():
    record = corrections()
    rates = [turn(record, 1e-4 * k, renew=k % CYCLE == 0) for k in range(2 * CYCLE)]
    assert len(set(rates[:CYCLE])) == len(set(rates[CYCLE:])) == 1
    assert rates[0] != rates[-1]
    assert turn(corrections(), 2.0, renew=True) == LIMITS.max_heading_rate
    assert turn(corrections(), -2.0, renew=True) == -LIMITS.max_heading_rate


def moved(pose, velocity, yaw):
    """Pose after a tick, with the yaw of then."""
    x, y, before = pose
    vx, vy, middle = *velocity, 0.5 * (before + yaw)
    return (
        x + CONTROL_PERIOD * (cos(middle) * vx - sin(middle) * vy),
        y + CONTROL_PERIOD * (sin(middle) * vx + cos(middle) * vy),
        yaw,
    )


def walk(velocity_at, slip, *, cycles=25, shift=0.0, sway=0.0):
    """Corrections tick by tick of a body that is faster by `slip` than its footsteps.

    Plan and body turn in frames of their own; the heading sways by `sway` [rad] within a cycle.
    Balance shifts the landing in the middle of each cycle forward by `shift` [m].
    """
    record, yaw, result = corrections(), 0.0, []
    pose, planned = (0.0, 0.0, 0.0), (0.4, -0.2, 0.9)
    for tick in range(cycles * CYCLE):
        vx, vy, wz = velocity_at(tick)
        begins = tick % CYCLE == 0
        landed = shift if tick % CYCLE == CYCLE // 2 else 0.0
        moved_by = (landed * cos(planned[2]), landed * sin(planned[2]))
        pose = (pose[0] + landed * cos(pose[2]), pose[1] + landed * sin(pose[2]), pose[2])
        planned = (planned[0] + moved_by[0], planned[1] + moved_by[1], planned[2])
        forward, left = speed_correction(record, pose, planned, moved_by, begins, PARAMETERS)
        result.append((forward, left))
        yaw += wz * CONTROL_PERIOD
        heading = yaw + sway * sin(2.0 * pi * (tick + 1) / CYCLE)
        vx, vy = vx + forward, vy + left
        pose = moved(pose, (vx + slip[0], vy + slip[1]), heading)
        planned = moved(planned, (vx, vy), heading + 0.9)
    return result


def always(*velocity):
    return lambda tick: velocity


def changing(tick):
    """Another velocity every quarter of a second."""
    return tuple(np.random.default_rng(tick // 50).uniform(-0.3, 0.3, 3).tolist())


@settings(max_examples=4)
@given(st.floats(-0.4, 0.4), st.floats(-0.15, 0.15), st.floats(-1.5, 1.5), slips, slips)
def test_a_walk_on_any_arc_gets_its_velocity(vx, vy, wz, ahead, aside):
    result = walk(always(vx, vy, wz), (ahead, aside))
    assert result[-1] == pytest.approx((-ahead, -aside), abs=1e-4)


def test_a_walk_whose_command_changes_all_the_time_gets_its_velocity():
    assert walk(changing, (0.01, -0.008))[-1] == pytest.approx((-0.01, 0.008), abs=1e-4)


@settings(max_examples=4)
@given(st.floats(-0.4, 0.4), st.floats(-1.5, 1.5), st.floats(-0.2, 0.2))
def test_sway_of_the_heading_is_not_an_error(forward, turn, sway):
    result = walk(always(forward, 0.0, turn), (0.0, 0.0), cycles=4, sway=sway)
    assert result[-1] == pytest.approx((0.0, 0.0), abs=1e-9)


@settings(max_examples=4)
@given(st.floats(-0.4, 0.4), st.floats(-1.5, 1.5), st.floats(-0.01, 0.01))
def test_shifts_of_the_landings_by_balance_do_not_change_the_speed(forward, turn, shift):
    result = walk(always(forward, 0.0, turn), (0.0, 0.0), shift=shift)
    faster = shift / (CYCLE * CONTROL_PERIOD)
    assert result[-1] == pytest.approx((-faster, 0.0), abs=1e-4)


def test_one_push_changes_the_speed_little():
    """The speed is corrected after the first cycle, at most by a part of the limit."""
    pushed = walk(always(0.2, 0.0, 0.0), (0.0, 0.0), cycles=3, shift=0.2)
    assert set(pushed[:CYCLE]) == {(0.0, 0.0)}
    change = LIMITS.max_speed_change
    assert pushed[CYCLE][0] == pytest.approx(-change)
    assert pushed[2 * CYCLE][0] == pytest.approx(-2.0 * change)


def test_the_speed_correction_is_limited_and_mirrored():
    one = walk(always(0.2, 0.05, 0.4), (-0.1, 0.1))
    other = walk(always(0.2, -0.05, -0.4), (-0.1, -0.1))
    limit = LIMITS.max_speed_correction
    assert one[-1] == pytest.approx((limit, -limit))
    assert np.array(other) == pytest.approx(np.array(one) * [1.0, -1.0], abs=1e-12)


def offsets(off, *, cycles=30, sway=0.02, disturbed=lambda tick: False, pressed=lambda tick: True):
    """CoM offsets tick by tick; the centre of pressure sways about the mass centre."""
    record, result = corrections(), []
    for tick in range(cycles * CYCLE):
        swayed = sway * sin(2.0 * pi * tick / CYCLE)
        x, y = record.com_offset.tolist()
        error = (off[0] + x + swayed, off[1] + y - swayed) if pressed(tick) else (0.0, 0.0)
        correct_offset(record, error, pressed(tick), tick % CYCLE == 0, disturbed(tick), PARAMETERS)
        result.append(tuple(record.com_offset.tolist()))
    return result


@settings(max_examples=4)
@given(offs, offs)
def test_the_mean_centre_of_pressure_is_moved_under_the_plan(ahead, aside):
    assert offsets((ahead, aside))[-1] == pytest.approx((-ahead, -aside), abs=2e-4)


def test_ticks_in_the_air_do_not_count():
    hopping = offsets((0.004, -0.003), sway=0.0, pressed=lambda tick: tick % 3 > 0)
    steady = offsets((0.004, -0.003), sway=0.0)
    assert np.array(hopping) == pytest.approx(np.array(steady), abs=1e-5)


def test_the_offset_moves_slowly_and_within_its_limit():
    result = offsets((-0.1, 0.1))
    assert result[-1] == pytest.approx((LIMITS.max_com_offset, -LIMITS.max_com_offset))
    fastest = max(abs(b[0] - a[0]) for a, b in pairwise(result))
    assert fastest <= LIMITS.max_com_offset_rate * CONTROL_PERIOD + 1e-12


def test_footsteps_that_balance_do_not_change_the_offset():
    assert set(offsets((0.01, 0.0), disturbed=lambda tick: tick % CYCLE == 7)) == {(0.0, 0.0)}


def test_the_speed_ratio_falls_with_the_error_to_its_minimum():
    ratios = [speed_ratio(corrections(), 0.001 * k, PARAMETERS) for k in range(100)]
    assert ratios == sorted(ratios, reverse=True)
    assert ratios[-1] == pytest.approx(LIMITS.min_speed_ratio)


def test_the_maximum_error_decays_with_its_time_constant():
    record, error = corrections(), 0.03
    speed_ratio(record, error, PARAMETERS)
    for _ in range(round(0.5 / CONTROL_PERIOD)):
        ratio = speed_ratio(record, 0.0, PARAMETERS)
    left = error * exp(-0.5 / LIMITS.slowdown_time)
    assert ratio == pytest.approx(speed_ratio(corrections(), left, PARAMETERS))


def test_a_touchdown_needs_the_phase_the_force_and_the_duration():
    record = corrections()
    ticks = ((0.3, 50.0), (0.7, 50.0), (0.72, 50.0), (0.74, 1.0), (0.76, 50.0))
    found = [detects_touchdown(record, phase, force, PARAMETERS) for phase, force in ticks]
    assert found == [False, False, True, False, False]
