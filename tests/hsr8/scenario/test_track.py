from dataclasses import replace
from math import hypot, inf, sqrt

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hsr8.scenario.path import Paths
from hsr8.scenario.track import Track

BOUND = sqrt(2.5)  # of the speed over the mean speed between two samples
coordinate = st.floats(-5.0, 5.0)


def track_of(times, points, **changes):
    times, points = np.asarray(times, dtype=float), np.asarray(points, dtype=float)
    given = {"id": "1", "begin": 0.0, "stays": False, "linger": 1.0, "away": 60.0} | changes
    return Track(times=tuple(times.tolist()), points=tuple(map(tuple, points.tolist())), **given)


@st.composite
def samples(draw):
    """Times (n,) and points (n, 2)."""
    steps = draw(st.lists(st.floats(0.05, 1.0), min_size=1, max_size=8))
    points = draw(
        st.lists(
            st.tuples(coordinate, coordinate), min_size=len(steps) + 1, max_size=len(steps) + 1
        )
    )
    return np.cumsum([draw(st.floats(-3.0, 3.0)), *steps]), np.array(points)


@st.composite
def tracks(draw):
    times, points = draw(samples())
    period = draw(st.sampled_from([inf, times[-1] - times[0] + 3.0]))
    changes = {"begin": draw(st.floats(-5.0, 5.0)), "first": times[0] - 1.5, "period": period}
    return track_of(times, points, stays=period == inf and draw(st.booleans()), **changes)


@given(samples())
def test_the_position_at_a_sample_is_that_of_the_file(given_samples):
    times, points = given_samples
    track = track_of(times, points)
    at = np.array([track.position(time) for time in times.tolist()])
    assert at == pytest.approx(points, abs=1e-9)


@settings(max_examples=15)
@given(samples())
def test_sampled_positions_are_those_of_the_track_and_dense(given_samples):
    track = track_of(*given_samples)
    moments, points = track.sampled(-10.0, 10.0, 0.05)
    at = np.array([track.position(moment) for moment in moments.tolist()[:-1:7]])
    assert points[:-1:7] == pytest.approx(at, abs=1e-9)
    assert np.hypot(*np.diff(points, axis=0).T).max() <= 0.05 + 1e-9


@given(samples(), st.floats(0.0, 1.0))
def test_no_speed_exceeds_the_bounds(given_samples, fraction):
    times, points = given_samples
    track = track_of(times, points)
    means = np.hypot(*np.diff(points, axis=0).T) / np.diff(times)
    for k, mean in enumerate(means.tolist()):
        time = float(times[k] + fraction * (times[k + 1] - times[k]))
        speed = hypot(*track.velocity(time))
        assert speed <= track.speed * (1.0 + 1e-9) + 1e-9
        if track.times[k] <= time < track.times[k + 1]:
            assert speed <= BOUND * mean * (1.0 + 1e-6) + 1e-6
    assert track.speed >= means.max() * (1.0 - 1e-9)
    assert track.speed <= 1.05 * BOUND * means.max() + 1e-9


@given(samples(), st.floats(0.0, 1.0))
def test_velocity_is_the_slope_of_position_and_continuous(given_samples, fraction):
    times, points = given_samples
    track, step = track_of(times, points), 1e-6
    time = float(times[0] + fraction * (times[-1] - times[0] - 4.0 * step)) + step
    before, after = np.array(track.position(time)), np.array(track.position(time + step))
    middle = np.array(track.velocity(time + 0.5 * step))
    assert (after - before) / step == pytest.approx(middle, abs=0.05)
    for sample in times[1:-1].tolist():
        jump = np.subtract(track.velocity(sample + step), track.velocity(sample - step))
        assert np.abs(jump).max() < 0.1


def test_the_velocity_at_a_sample_has_the_direction_of_the_parabola_through_its_neighbours():
    times = [0.0, 0.3, 1.2]
    vx, vy = track_of(times, [(t, 0.5 * t * t) for t in times]).velocity(0.3)
    assert vy / vx == pytest.approx(0.3)


def test_a_turning_point_is_not_overshot():
    track = track_of([0.0, 1.0, 2.0], [(0.0, 0.0), (1.0, 0.0), (0.0, 0.0)])
    assert max(track.position(time)[0] for time in np.linspace(0.0, 2.0, 201).tolist()) == 1.0


@given(samples(), st.floats(0.1, 5.0), st.floats(0.2, 5.0), st.floats(0.0, 1.0))
def test_a_scaled_recording_is_walked_along_scaled_curves(given_samples, length, time, fraction):
    times, points = given_samples
    offset = np.array([3.0, -2.0])
    small, big = track_of(times, points), track_of(time * times, offset + length * points)
    moment = float(times[0] + fraction * (times[-1] - times[0]))
    assume(np.abs(times - moment).min() > 1e-6)
    # A turn by a right angle may be more or less after rounding.
    means = np.diff(points, axis=0) / np.diff(times)[:, None]
    dots = (means[:-1] * means[1:]).sum(axis=1)
    sizes = np.hypot(*means[:-1].T) * np.hypot(*means[1:].T)
    assume((np.abs(dots) > 1e-6 * sizes).all() and (sizes > 1e-6).all())
    expected = offset + length * np.array(small.position(moment))
    assert big.position(time * moment) == pytest.approx(tuple(expected), abs=1e-6)
    rate = length / time
    velocity = tuple(rate * v for v in small.velocity(moment))
    assert big.velocity(time * moment) == pytest.approx(velocity, rel=1e-3, abs=1e-3)
    assert big.speed == pytest.approx(rate * small.speed, rel=1e-6, abs=1e-6)


@given(st.lists(tracks(), min_size=1, max_size=5), st.lists(st.floats(0.0, 30.0), min_size=1))
def test_all_together_are_each_alone(chosen, instants):
    table = Paths([track.path for track in chosen])
    together = table.positions(np.array(instants)[:, None])
    for k, time in enumerate(instants):
        assert together[k] == pytest.approx(
            np.array([track.position(time) for track in chosen]), abs=1e-9
        )
        assert np.array_equal(together[k], table.positions(np.array([time])))
        velocities = np.array([track.velocity(time) for track in chosen])
        assert table.velocities(np.array([time])) == pytest.approx(velocities, abs=1e-9)


SHORT = track_of([1.0, 2.0], [(0.0, 0.0), (1.0, 0.0)], linger=0.5)


def test_a_mover_that_leaves_is_away_before_and_after_its_track():
    assert [SHORT.present(time) for time in (0.4, 0.5, 1.5, 2.4, 2.5)] == [
        *(False, True, True, True, False)
    ]
    assert SHORT.position(0.4) == (60.0, 0.0)
    assert SHORT.position(0.6) == (0.0, 0.0)
    assert SHORT.velocity(0.6) == SHORT.velocity(2.0) == (0.0, 0.0)
    assert SHORT.position(2.4) == (1.0, 0.0)


def test_a_mover_that_stays_waits_and_stays():
    track = replace(SHORT, stays=True)
    assert track.position(-9.0) == (0.0, 0.0)
    assert track.position(1.5) == (0.5, 0.0)
    assert track.position(99.0) == (1.0, 0.0)


@given(st.floats(0.0, 20.0))
def test_a_repeated_recording_has_its_period(time):
    track = replace(SHORT, first=0.5, period=2.0, begin=1.25)
    assert track.position(time + 2.0) == pytest.approx(track.position(time), abs=1e-9)
    assert track.recorded_time(0.0) == pytest.approx(1.25)
