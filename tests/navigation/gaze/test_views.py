from math import tan

import numpy as np
import pytest

from navigation.gaze.views import Look, move_time, view_values

RATE, ACCELERATION = 3.0, 40.0
EYE, LENS = np.array([0.04, 0.46]), np.array([tan(0.5), tan(0.4)])
LOOK_TIME, MAX_URGENCY = 0.25, 4.0


def moved(time, angle, speed, steps=20_000):
    """Angle and speed left after the fastest move: full acceleration, switched once or twice."""
    dt = time / steps
    for k in range(steps):
        left = time - k * dt
        stopping = 0.5 * speed * abs(speed) / ACCELERATION
        push = np.sign(angle - stopping) or -np.sign(speed)
        speed = np.clip(speed + push * ACCELERATION * dt, -RATE, RATE)
        angle -= speed * dt
        assert left > 0.0
    return angle, speed


@pytest.mark.parametrize("speed", [-2.0, 0.0, 1.0, 3.0])
@pytest.mark.parametrize("angle", [-1.2, -0.05, 0.1, 0.9])
def test_a_head_that_accelerates_fully_arrives_in_the_time_of_the_move(angle, speed):
    left, rate = moved(move_time(angle, speed, RATE, ACCELERATION), angle, speed)
    assert left == pytest.approx(0.0, abs=2e-3)
    assert rate == pytest.approx(0.0, abs=0.1)


def look(x, y, weight=1.0, base=1.0, rate=0.0, *, top=0.0, credit=0.0):
    return np.array([(x, y, weight, base, rate, top, credit, False)], Look)


STILL = (0.0, 0.0, -0.4, 0.0)


def values(looks, *, pans=(0.0,), tilts=(-0.4,), neck=STILL, turn=(0.0, 1.6)):
    motion = np.array([*neck, RATE, ACCELERATION])
    views = np.array(pans), np.array(tilts)
    limits = LOOK_TIME, MAX_URGENCY, np.array(turn)
    return view_values(*views, looks, EYE, LENS, motion, *limits)


@pytest.mark.parametrize("pan", [-1.2, 0.0, 0.6])
@pytest.mark.parametrize("tilt", [-0.9, -0.3])
def test_a_view_counts_the_points_that_a_pinhole_camera_projects_into_its_image(pan, tilt):
    rng = np.random.default_rng(1)
    c, s = np.cos([pan, tilt]), np.sin([pan, tilt])
    forward = np.array([c[0] * c[1], s[0] * c[1], s[1]])
    right = np.array([s[0], -c[0], 0.0])
    down = np.cross(forward, right)
    eye = np.array([EYE[0] * c[0], EYE[0] * s[0], EYE[1]])
    for x, y in rng.uniform(-2.5, 2.5, (300, 2)):
        ray = np.array([x, y, 0.0]) - eye
        depth = ray @ forward
        inside = depth > 0.05 and np.all(np.abs([ray @ right, ray @ down]) <= LENS * depth)
        value = values(look(x, y), pans=[pan], tilts=[tilt], neck=(pan, 0.0, tilt, 0.0))
        assert (value[0, 0] > 0.0) == inside


def test_values_of_looks_add_up_over_the_time_of_saccade_and_look():
    one, other = look(1.0, 0.1), look(0.9, -0.1, weight=2.0)
    pans, tilts = np.linspace(-1.5, 1.5, 7), np.array([-0.8, -0.4])
    both = values(np.concatenate([one, other]), pans=pans, tilts=tilts)
    assert both == pytest.approx(
        values(one, pans=pans, tilts=tilts) + values(other, pans=pans, tilts=tilts)
    )
    away = (1.0, 0.0, -0.4, 0.0)
    time = move_time(-1.0, 0.0, RATE, ACCELERATION)
    assert values(one)[0, 0] == pytest.approx(1.0 / LOOK_TIME)
    assert values(one, neck=away)[0, 0] == pytest.approx(1.0 / (LOOK_TIME + time))


def test_the_urgency_grows_during_the_saccade_up_to_its_limit():
    away = (1.0, 0.0, -0.4, 0.0)
    time = move_time(-1.0, 0.0, RATE, ACCELERATION)
    growing = values(look(1.0, 0.0, base=0.5, rate=2.0), neck=away)[0, 0]
    assert growing == pytest.approx((0.5 + 2.0 * time) ** 1.5 / (LOOK_TIME + time))
    for base in (4.0, 9.0):
        assert values(look(1.0, 0.0, base=base, rate=2.0))[0, 0] == pytest.approx(8.0 / LOOK_TIME)


@pytest.mark.parametrize("rate", [-0.8, 0.8])
def test_a_view_that_the_turning_body_moves_out_of_reach_is_worth_nothing(rate):
    ring = np.concatenate([look(np.cos(a), np.sin(a)) for a in np.linspace(-1.9, 1.9, 40)])
    pans = np.linspace(-1.5, 1.5, 31)
    still, turning = (values(ring, pans=pans, turn=(r, 1.5))[0] for r in (0.0, rate))
    times = np.array([move_time(pan, 0.0, RATE, ACCELERATION) for pan in pans]) + LOOK_TIME
    kept = np.abs(pans - rate * times) <= 1.5
    assert 0 < kept.sum() < len(pans)
    assert turning == pytest.approx(np.where(kept, still, 0.0))


def test_a_foot_alone_has_its_credit():
    def part(distance, tilt, top, credit):
        looks = look(distance + EYE[0], 0.0, top=top, credit=credit)
        return LOOK_TIME * values(looks, tilts=[tilt], neck=(0.0, 0.0, tilt, 0.0))[0, 0]

    assert part(0.3, -0.9, 0.40, 0.7) == pytest.approx(0.7)
    assert part(0.3, -0.9, 0.40, 0.0) == 0.0
    assert part(0.3, 0.5, 0.40, 0.7) == 0.0
    assert part(0.5, -0.2, 0.40, 0.7) == 1.0
    assert part(0.5, -0.2, 0.40, 0.0) == 1.0
    assert part(3.0, -0.5, 0.6, 0.0) == 0.0
