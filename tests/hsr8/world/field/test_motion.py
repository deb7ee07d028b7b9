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
PASSAGE = Passage((-1.0, 0.0), (1.0, 1.5), 0.25, depart=4.0)
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
)


@given(st.lists(motions, max_size=6), times)
def test_all_together_are_each_alone(chosen, time):
    movers = Movers(tuple(chosen))
    positions = np.array([motion.position(time) for motion in chosen]).reshape(-1, 2)
    velocities = np.array([motion.velocity(time) for motion in chosen]).reshape(-1, 2)
    # A shuttle at its very end may have turned in one evaluation and not in the other.
    turning = [
        isinstance(motion, Shuttle)
        and min(_to_end(motion, time), motion.length - _to_end(motion, time)) < 1e-9
        for motion in chosen
    ]
    assert movers.positions(time) == pytest.approx(positions, abs=1e-9)
    keep = ~np.array(turning, dtype=bool)
    assert movers.velocities(time)[keep] == pytest.approx(velocities[keep], abs=1e-9)


@given(st.lists(motions, max_size=6), st.lists(times, min_size=1, max_size=4))
def test_many_times_at_once_are_each_alone(chosen, instants):
    movers = Movers(tuple(chosen))
    for values in (movers.positions, movers.velocities):
        together = values(np.array(instants))
        assert np.array_equal(together, np.array([values(time) for time in instants]))


TRACK = Track(
    id="1",
    times=(1.0, 3.0, 4.0),
    points=((0.0, 1.0), (1.0, 1.5), (2.0, 1.0)),
    begin=-2.0,
    stays=False,
    linger=0.5,
    away=60.0,
)


@given(st.lists(st.sampled_from([TRACK, PASSAGE, *LAWS[:2]]), min_size=1, max_size=5), times)
def test_recorded_movers_are_evaluated_with_the_others(chosen, time):
    movers = Movers(chosen)
    for instant in (time, 0.01 * time):
        positions = np.array([motion.position(instant) for motion in chosen]).reshape(-1, 2)
        velocities = np.array([motion.velocity(instant) for motion in chosen]).reshape(-1, 2)
        assert movers.positions(instant) == pytest.approx(positions, abs=1e-9)
        assert movers.velocities(instant) == pytest.approx(velocities, abs=1e-9)
    assert movers.top_speeds().tolist() == [pace(motion) for motion in chosen]


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


@given(shuttles(), times)
def test_shuttle_comes_back_after_there_and_back(motion, time):
    period = 2.0 * motion.length / motion.speed
    assert motion.position(time + period) == pytest.approx(motion.position(time), abs=1e-8)


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
    assert speed == pytest.approx(pace(motion)) or speed == 0.0


def test_a_passage_waits_moves_and_stays():
    assert PASSAGE.position(3.9) == PASSAGE.start
    assert PASSAGE.velocity(3.9) == (0.0, 0.0)
    assert PASSAGE.position(4.0 + 5.0) == pytest.approx((0.0, 0.75))
    assert PASSAGE.position(4.0 + 10.0) == pytest.approx(PASSAGE.end)
    assert PASSAGE.position(50.0) == PASSAGE.end
    assert PASSAGE.velocity(50.0) == (0.0, 0.0)


@given(laws, times)
def test_the_speed_is_constant(motion, time):
    assert hypot(*motion.velocity(time)) == pytest.approx(0.12, rel=1e-4)


@given(laws, times)
def test_it_comes_back_after_once_round(motion, time):
    assert motion.position(time + motion.length / motion.speed) == pytest.approx(
        motion.position(time)
    )


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
