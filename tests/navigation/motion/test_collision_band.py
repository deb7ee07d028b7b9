from math import hypot, inf, isfinite

import numpy as np
import pytest

from navigation.motion.collision_band import CollisionCase, Encounter, free_intervals


def encounters(rng, n):
    """Random encounters that do not overlap at the start."""
    result = []
    while len(result) < n:
        point, velocity = rng.uniform(-1.5, 1.5, 2), rng.normal(0, 0.12, 2)
        radius = float(rng.uniform(0.1, 0.4))
        if hypot(*point.tolist()) > radius:
            result.append(Encounter(*point.tolist(), *velocity.tolist(), radius))
    return result


def brute_force_contact(e, speed, horizon=200.0):
    """Least distance by closed form in time, independent of the roots."""
    u, w = e.forward - speed, e.left
    square = u * u + w * w
    time = 0.0 if square == 0.0 else -(e.along * u + e.across * w) / square
    time = min(max(time, 0.0), horizon)
    return hypot(e.along + u * time, e.across + w * time) < e.radius


def test_colliding_speeds_are_those_of_the_quadratic():
    """20 000 random speeds: the sign of A v² + B v + C and the closing test decide."""
    rng = np.random.default_rng(0)
    signs = set()
    for e in encounters(rng, 4000):
        for speed in rng.uniform(0.0, 0.3, 5).tolist():
            s2 = e.radius**2
            a = e.along * e.left - e.across * e.forward
            b = -e.across
            qa, qb = b * b - s2, 2 * (s2 * e.forward - a * b)
            qc = a * a - s2 * (e.forward**2 + e.left**2)
            closing = -(e.along * (e.forward - speed) + e.across * e.left) > 0.0
            value = qa * speed**2 + qb * speed + qc
            if abs(value) > 1e-9:
                hits = value < 0.0 and closing
                assert hits == brute_force_contact(e, speed, 1e9)
                assert hits == isfinite(e.contact_time(speed))
                signs.add(qa > 0.0)
    assert signs == {True, False}


def test_the_band_is_where_a_standing_robot_is_hit():
    rng = np.random.default_rng(3)
    for e in encounters(rng, 3000):
        assert e.in_band() == isfinite(e.contact_time(0.0))


@pytest.mark.parametrize("horizon", [inf, 6.0])
def test_free_intervals_agree_with_sampling(horizon):
    rng = np.random.default_rng(4)
    all_ = encounters(rng, 1200)
    for group in zip(all_[::3], all_[1::3], all_[2::3], strict=True):
        intervals = free_intervals(group, 0.2, horizon)
        ends = [x for i in intervals for x in i]
        for speed in np.linspace(0.0, 0.2, 21).tolist():
            if min((abs(speed - x) for x in ends), default=1.0) < 1e-6:
                continue
            free = not any(e.collides(speed, horizon) for e in group)
            assert free == any(low <= speed <= high for low, high in intervals)


def test_the_letters_of_figure_4():
    crossing = Encounter(1.0, -1.0, 0.0, 0.15, 0.3)
    assert crossing.case(0.2, inf) is CollisionCase.CROSSING
    head_on = Encounter(1.0, 0.0, -0.1, 0.0, 0.3)
    assert head_on.case(0.2, inf) is CollisionCase.DEFINITE
    leaving = Encounter(0.5, 0.0, 0.05, 0.0, 0.3)
    assert leaving.case(0.2, inf) is CollisionCase.RECEDING
    from_the_side = Encounter(0.1, -0.6, 0.0, 0.1, 0.3)
    assert from_the_side.case(0.2, inf) is CollisionCase.ESCAPE
    assert Encounter(1.0, 1.0, 0.0, 0.15, 0.3).case(0.2, inf) is None


def test_at_the_points_of_contact_of_figure_4_disc_and_robot_touch():
    rng = np.random.default_rng(6)
    result = 0
    for e in encounters(rng, 500):
        for v in e.crossing_speeds():
            time = e.touch_time(v)
            if isfinite(time):
                x, y = e.along + e.forward * time, e.across + e.left * time
                assert hypot(x - v * time, y) == pytest.approx(e.radius, abs=1e-9)
                result += 1
    assert result > 200
    e = Encounter(1.0, -1.0, 0.0, 0.15, 0.3)
    assert e.touch_time(0.05) == inf


def test_the_case_takes_the_horizon():
    """A collision later than the horizon is none: the free speeds are those of its time."""
    head_on = Encounter(2.2, 0.0, -0.1, 0.0, 0.3)
    assert [head_on.contact_time(v) for v in (0.0, 0.2)] == pytest.approx([19.0, 19.0 / 3.0])
    cases = [head_on.case(0.2, horizon) for horizon in (inf, 20.0, 10.0)]
    assert cases == [CollisionCase.DEFINITE, CollisionCase.DEFINITE, CollisionCase.ESCAPE]
    rng = np.random.default_rng(7)
    for e in encounters(rng, 500):
        for horizon in (2.0, 6.0, inf):
            free = not any(e.collides(v, horizon) for v in np.linspace(1e-6, 0.2, 41).tolist())
            case = e.case(0.2, horizon)
            if case is CollisionCase.DEFINITE:
                assert all(e.collides(v, horizon) for v in np.linspace(0.001, 0.199, 41).tolist())
            if case is None:
                assert free
