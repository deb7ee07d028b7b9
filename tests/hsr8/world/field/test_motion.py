from math import hypot, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.scenario.track import Track
from hsr8.world.field.motion import ALWAYS, Circle, Line, Movers, Passage, Shuttle, pace
from hsr8.world.field.wander import CORNERS, MIN_BEND_RADIUS, draw_wander

coordinate = st.floats(-3.0, 3.0)
point = st.tuples(coordinate, coordinate)
speed = st.floats(0.02, 0.5)
times = st.floats(0.0, 600.0)
TRACK = Track(
    id="1",
    times=(1.0, 3.0, 4.0),
    points=((0.0, 1.0), (1.0, 1.5), (2.0, 1.0)),
    begin=-2.0,
    stays=False,
    linger=0.5,
    away=60.0,
)
EXTENT = 1.4
LAWS = [draw_wander(np.random.default_rng(k), (0.5, -0.2), EXTENT, 0.12) for k in range(12)]
laws = st.sampled_from(LAWS)


@st.composite
def shuttles(draw):
    start, angle = draw(point), draw(st.floats(-pi, pi))
    length = draw(st.floats(0.3, 3.0))
    end = (start[0] + length * np.cos(angle), start[1] + length * np.sin(angle))
    return Shuttle(start, (float(end[0]), float(end[1])), draw(speed), draw(st.floats(0.0, 6.0)))


circles = st.builds(
    Circle,
    point,
    st.floats(0.2, 2.0),
    speed.flatmap(lambda v: st.sampled_from([v, -v])),
    coordinate,
)
passages = st.builds(
    lambda shuttle, depart: Passage(shuttle.start, shuttle.end, shuttle.speed, depart),
    shuttles(),
    st.floats(0.0, 60.0),
)
wanders = st.builds(
    lambda seed, centre, pace: draw_wander(np.random.default_rng(seed), centre, 1.5, pace),
    st.integers(0, 99),
    point,
    speed,
)
motions = st.one_of(
    passages,
    wanders,
    shuttles(),
    circles,
    st.builds(Line, point, point),
    st.builds(Line, point, st.just((0.0, 0.0))),
    st.just(TRACK),
)


@given(st.lists(motions, max_size=6), times)
def test_all_together_are_each_alone(chosen, time):
    movers = Movers(tuple(chosen))
    positions = np.array([motion.position(time) for motion in chosen]).reshape(-1, 2)
    velocities = np.array([motion.velocity(time) for motion in chosen]).reshape(-1, 2)
    assert movers.positions(time) == pytest.approx(positions, abs=1e-12)
    assert movers.velocities(time) == pytest.approx(velocities, abs=1e-12)


@given(st.lists(motions, max_size=6), st.lists(times, min_size=1, max_size=4))
def test_many_times_at_once_are_each_alone(chosen, instants):
    movers = Movers(tuple(chosen))
    for values in (movers.positions, movers.velocities):
        together = values(np.array(instants))
        assert np.array_equal(together, np.array([values(time) for time in instants]))


@given(motions, times, st.floats(0.1, 600.0))
def test_a_mover_is_away_outside_its_interval(motion, time, begin):
    movers = Movers([motion, motion], [ALWAYS, (begin, 2.0 * begin)], away=50.0)
    (nominal, appearing), (velocity, shown) = movers.positions(time), movers.velocities(time)
    present = begin <= time + 1e-6 < 2.0 * begin
    assert appearing - nominal == pytest.approx((0.0, 0.0) if present else (50.0, 0.0))
    assert shown == pytest.approx(present * velocity)


@given(motions, times)
def test_velocity_is_the_slope_of_position(motion, time):
    step = 1e-5
    jump = np.subtract(motion.velocity(time), motion.velocity(time + step))
    if np.abs(jump).max() > 1e-4:  # a reversal, a departure, a corner
        return
    before, after = np.array(motion.position(time)), np.array(motion.position(time + step))
    assert (after - before) / step == pytest.approx(np.array(motion.velocity(time)), abs=1e-4)


@given(shuttles(), times)
def test_shuttle_stays_in_its_lane_at_its_speed(motion, time):
    assert 0.0 <= _to_end(motion, time) <= motion.length + 1e-9
    assert hypot(*motion.velocity(time)) == pytest.approx(motion.speed)


@given(circles, times)
def test_circle_stays_on_its_rim(motion, time):
    x, y = motion.position(time)
    assert hypot(x - motion.centre[0], y - motion.centre[1]) == pytest.approx(motion.radius)
    assert hypot(*motion.velocity(time)) == pytest.approx(abs(motion.speed))


def _to_end(motion: Shuttle, time: float) -> float:
    """Distance from the start of the lane."""
    x, y = motion.position(time)
    return hypot(x - motion.start[0], y - motion.start[1])


@given(motions, times)
def test_a_mover_goes_at_its_pace_or_rests(motion, time):
    speed = hypot(*motion.velocity(time))
    assert speed == pytest.approx(pace(motion), rel=1e-4) or speed == 0.0 or motion is TRACK
    assert speed <= pace(motion) * (1.0 + 1e-4)


@given(st.one_of(shuttles(), wanders), times)
def test_a_closed_path_has_its_period(motion, time):
    round_trip = motion.length * (2.0 if isinstance(motion, Shuttle) else 1.0) / motion.speed
    assert motion.position(time + round_trip) == pytest.approx(motion.position(time), abs=1e-8)


@given(passages, st.floats(0.0, 1.0))
def test_a_passage_waits_moves_and_stays(motion, fraction):
    duration = motion.length / motion.speed
    assert motion.position(fraction * motion.depart) == pytest.approx(motion.start)
    along = np.array(motion.start) + fraction * np.subtract(motion.end, motion.start)
    assert motion.position(motion.depart + fraction * duration) == pytest.approx(along, abs=1e-9)
    assert motion.position(motion.depart + (1.0 + fraction) * duration) == pytest.approx(motion.end)


@pytest.mark.parametrize("motion", LAWS)
def test_the_track_fills_its_box_and_no_more(motion):
    track = np.array(motion.track)
    extent = np.ptp(track, axis=0)
    assert extent.max() == pytest.approx(EXTENT, abs=0.01)
    assert 0.5 * (track.max(axis=0) + track.min(axis=0)) == pytest.approx((0.5, -0.2), abs=0.01)


@pytest.mark.parametrize("motion", LAWS)
def test_the_track_bends_gently(motion):
    sides = np.diff(np.array([*motion.track, *motion.track[:2]]), axis=0)
    heading = np.unwrap(np.arctan2(sides[:, 1], sides[:, 0]))
    turns = np.abs(np.diff(heading))
    assert len(motion.track) == CORNERS
    # The track was looked at in a few places, and a polygon turns at its corners only.
    assert turns.max() <= 1.3 * motion.side / MIN_BEND_RADIUS


def test_an_extent_too_small_for_the_bends_has_no_track():
    assert draw_wander(np.random.default_rng(0), (0.0, 0.0), 0.1, 0.1) is None
