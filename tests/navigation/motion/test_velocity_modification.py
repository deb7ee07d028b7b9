from math import inf

import numpy as np
import pytest

from navigation.decision import SpeedLimits
from navigation.motion.collision_band import Encounter
from navigation.motion.velocity_modification import modify_speed, needed_acceleration, sample_speed
from navigation.parameters.motion import MovingObstacleParameters

V_MAX = 0.2


def limited(acceleration):
    return SpeedLimits(V_MAX, 0.1, 0.08, 0.8, acceleration, 0.34)


def closed(encounters, desired=0.2, now=0.2, acceleration=0.3, horizon=6.0, wait=False):
    p = MovingObstacleParameters(horizon=horizon, wait_in_band=wait)
    return modify_speed(encounters, desired, now, limited(acceleration), p)


def sampled(
    encounters, desired=0.2, now=0.2, acceleration=10.0, horizon=6.0, wait=False, samples=21
):
    p = MovingObstacleParameters(horizon=horizon, wait_in_band=wait, samples=samples)
    return sample_speed(encounters, desired, now, limited(acceleration), p)


def scene(rng):
    count = int(rng.integers(1, 4))
    return tuple(
        Encounter(*rng.uniform(-1, 1, 2).tolist(), *rng.normal(0, 0.1, 2).tolist(), 0.2)
        for _ in range(count)
    )


def test_without_movers_the_speed_stays():
    assert closed(()).speed == 0.2
    assert closed(()).situation == "free"
    assert sampled(()).speed == 0.2
    assert sampled(()).situation == "free"


def test_the_chosen_speed_is_free_or_the_path_must_change():
    rng = np.random.default_rng(0)
    situations = set()
    for _ in range(1500):
        movers = scene(rng)
        desired = float(rng.uniform(0.02, V_MAX))
        choice = closed(movers, desired, desired)
        situations.add(choice.situation)
        if choice.situation == "path_change":
            assert choice.speed == desired
        else:
            assert all(e.contact_time(choice.speed) > 6.0 for e in movers)
    assert situations == {"free", "accelerate", "brake", "escape", "path_change"}


@pytest.mark.parametrize("wait", [True, False])
def test_closed_form_and_samples_agree_within_one_sample(wait):
    rng = np.random.default_rng(1)
    step = V_MAX / 200
    same = 0
    for _ in range(600):
        movers = scene(rng)
        desired = round(float(rng.uniform(0.02, V_MAX)) / step) * step
        one = closed(movers, desired, desired, acceleration=inf, wait=wait)
        other = sampled(movers, desired, desired, samples=201, wait=wait)
        if one.situation == other.situation:
            assert abs(one.speed - other.speed) <= step + 1e-8
            same += 1
    assert same > 590


def test_the_robot_passes_first_if_it_can_and_waits_if_it_cannot():
    crossing = (Encounter(0.45, -0.7, 0.0, 0.1, 0.2),)
    fast = closed(crossing, desired=0.06, now=0.06, acceleration=inf)
    slow = closed(crossing, desired=0.06, now=0.06, acceleration=0.0)
    assert fast.situation == "accelerate"
    assert fast.speed > 0.06
    assert slow.situation == "brake"
    assert slow.speed < 0.06


def test_a_definite_collision_changes_the_path():
    assert closed((Encounter(0.6, 0.0, -0.1, 0.0, 0.3),)).situation == "path_change"


def test_collisions_beyond_the_horizon_are_ignored():
    far = (Encounter(1.9, 0.0, -0.05, 0.0, 0.3),)
    assert closed(far, horizon=6.0).situation == "free"
    assert closed(far, horizon=60.0).situation == "path_change"


def test_the_needed_acceleration_brings_the_robot_there_in_time():
    speed, wanted, time = 0.05, 0.15, 2.0
    a = needed_acceleration(speed, wanted, time, 0.34)
    assert speed * time + 0.5 * a * time**2 == pytest.approx(wanted * time)
    assert needed_acceleration(speed, wanted, 0.0, 0.34) == pytest.approx(2 * 0.1 / 0.34)


def test_the_speed_that_passes_first_does_not_jump_where_the_robot_enters_the_band():
    """From case (a) to case (b): the lateral distance from the mover's path crosses S."""
    result = 0
    for along in np.linspace(0.25, 1.5, 26).tolist():
        outside, inside = (
            closed((Encounter(0.3 + e, -along, 0.0, 0.1, 0.3),), desired=0.05, now=0.05,
                   acceleration=inf, horizon=60.0)
            for e in (1e-7, -1e-7)
        )  # fmt: skip
        if outside.situation == "accelerate":
            assert inside.situation == "escape"
            assert outside.speed == pytest.approx(inside.speed, abs=1e-5)
            result += 1
    assert result > 10


@pytest.mark.parametrize("choose", [closed, sampled])
def test_inside_the_band_the_robot_does_not_wait(choose):
    """Slower is free only until the horizon: the contact is put off, not avoided."""
    head_on = (Encounter(1.4, 0.0, -0.1, 0.0, 0.3),)
    slow = head_on[0].contact_time(0.0)
    assert 6.0 < slow < 12.0
    choice = choose(head_on, horizon=6.0)
    assert (choice.situation, choice.speed) == ("path_change", 0.2)
    assert choose(head_on, horizon=6.0, wait=True).situation == "brake"
    crossing = (Encounter(0.6, -0.8, 0.0, 0.1, 0.2),)
    assert choose(crossing, desired=0.1, now=0.1).situation in {"brake", "accelerate"}


def test_a_speed_that_cannot_be_gained_in_time_is_not_chosen():
    crossing = (Encounter(0.45, -0.7, 0.0, 0.1, 0.2),)
    needed = sampled(crossing, desired=0.06, now=0.06).speed - 0.06
    for factor, situation in ((1.01, "accelerate"), (0.99, "brake")):
        choice = sampled(crossing, desired=0.06, now=0.06, acceleration=factor * needed / 0.8)
        assert choice.situation == situation


def test_the_acceleration_limit_is_that_of_the_formula():
    crossing = (Encounter(0.45, -0.7, 0.0, 0.1, 0.2),)
    fast = closed(crossing, desired=0.06, now=0.06, acceleration=inf).speed
    a = needed_acceleration(0.06, fast, crossing[0].touch_time(fast), 0.34)
    assert closed(crossing, desired=0.06, now=0.06, acceleration=1.001 * a).speed == fast
    assert closed(crossing, desired=0.06, now=0.06, acceleration=0.999 * a).situation == "brake"
