from math import cos, pi, sin

import numpy as np
import pytest

from navigation.angles import wrap
from navigation.belief.belief import Motion
from navigation.motion.rear_check import RearCheck, sectors
from navigation.parameters.motion import RearCheckParameters

P = RearCheckParameters()
REACH = 2.2  # [rad]
SPEED = 0.2  # [m/s]
EDGE = 0.01  # [rad]


@pytest.fixture
def check():
    return RearCheck(P, REACH, 0.12, SPEED)


def stale(inside, pose=(0.0, 0.0, 0.0), age=9.0):
    """Age of ground that is old where `inside` holds for its bearing from a pose."""
    x0, y0, heading = pose
    return lambda x, y: age if inside(wrap(np.arctan2(y - y0, x - x0) - heading)) else 0.0


def beside(bearing):
    return REACH - EDGE < bearing < REACH + P.near_angle + EDGE


def right_behind(bearing):
    return abs(bearing) > REACH + P.near_angle - EDGE


def sector(aside):
    return [s.aside for s in sectors(P, REACH)].index(aside)


def cloud(place):
    return ([place], [[0.0, 0.0]], [1.0])


def test_all_round_is_in_reach_of_the_gaze_or_in_a_sector():
    found = sectors(P, REACH)
    for bearing in np.linspace(-pi, pi, 181):
        covered = [abs(wrap(bearing - s.middle)) <= s.half for s in found]
        assert any(covered) or abs(bearing) <= REACH + 1e-9


def test_a_body_turned_aside_has_the_whole_sector_in_reach():
    for s in sectors(P, REACH):
        assert np.abs(s.bearing - s.aside).max() == pytest.approx(REACH)


def test_what_was_just_seen_is_not_turned_for(check, belief):
    assert check.aside(belief(), 0.0, SPEED) == 0.0
    assert check.look_request() is None


@pytest.mark.parametrize("side", [1, -1])
def test_old_ground_is_turned_for_from_its_side_as_far_as_it_takes(side, belief):
    for inside, angle in ((beside, P.near_angle), (right_behind, P.far_angle)):
        check = RearCheck(P, REACH, 0.12, SPEED)
        b = belief(age=stale(lambda bearing, i=inside: bearing * side > 0 and i(side * bearing)))
        assert check.aside(b, 0.0, 0.03) == side * angle
        look_request = check.look_request()
        assert np.sign(look_request) == side
        assert abs(wrap(look_request - side * angle)) < REACH


def test_the_answer_turns_and_moves_with_the_scene(belief):
    pose, course = (2.0, -1.0, 0.4), 1.1
    way = (*pose[:2], course)
    here = RearCheck(P, REACH, 0.12, SPEED)
    there = RearCheck(P, REACH, 0.12, SPEED)
    one = here.aside(belief(age=stale(beside)), 0.0, SPEED)
    other = there.aside(belief(pose=pose, age=stale(beside, way)), course, SPEED)
    assert one == pytest.approx(other) == P.near_angle
    assert there.look_request() == pytest.approx(here.look_request() + course)


def test_it_keeps_to_what_it_turned_for_until_that_was_seen(check, belief):
    both = stale(lambda bearing: beside(abs(bearing)))
    first = check.aside(belief(age=both), 0.0, SPEED)
    right = stale(lambda bearing: beside(-bearing))
    assert check.aside(belief(age=both, time=1.0), 0.0, SPEED) == first
    assert check.aside(belief(age=right, time=1.4), 0.0, SPEED) == -first
    assert check.aside(belief(time=1.8), 0.0, SPEED) == 0.0


@pytest.mark.parametrize("side", [1, -1])
def test_what_is_looked_at_stays_where_it_is_though_the_way_turns(check, belief, side):
    stale_side = stale(lambda bearing: beside(side * bearing))
    assert check.aside(belief(age=stale_side), 0.0, SPEED) == side * P.near_angle
    look_request = check.look_request()
    for course in (0.1, -0.1, 0.3, 0.0):
        aside = check.aside(belief(age=stale_side, time=0.4), course, SPEED)
        assert check.look_request() == look_request
        assert course + aside == pytest.approx(side * P.near_angle)
    # A way that turns to where it is in reach anyway needs no more, one that turns away no end.
    assert check.aside(belief(age=stale_side, time=0.4), side * 1.0, SPEED) == 0.0
    away = check.aside(belief(age=stale_side, time=0.4), -side * 2.0, SPEED)
    assert away == side * P.far_angle


def test_what_cannot_be_seen_is_given_up_for_a_while(check, belief):
    def at(time):
        return check.aside(belief(age=stale(beside), time=time), 0.0, SPEED)

    late = P.max_turn_time + 0.1
    assert at(0.0) == P.near_angle
    assert at(P.max_turn_time) == P.near_angle
    assert at(late) == 0.0
    assert at(late + 0.9 * P.retry_delay) == 0.0
    assert at(late + 1.1 * P.retry_delay) == P.near_angle


def test_the_slower_the_robot_the_sooner_what_is_right_behind_is_due(check, belief):
    behind = sector(P.far_angle)
    b = belief(age=stale(right_behind, age=2.0))
    urgency = [check.urgency(b, 0.0, v)[behind] for v in (0.0, 0.05, 0.1, 0.2)]
    assert np.all(np.diff(urgency) < 0.0)


def test_a_lost_mover_behind_is_turned_for_and_one_in_view_is_not(check, belief, track):
    bearing = REACH + 0.5 * P.near_angle
    place = (0.5 * cos(bearing), 0.5 * sin(bearing))
    seen = track(place, (0.1, 0.0), age=0.1)
    assert check.aside(belief([seen]), 0.0, SPEED) == 0.0
    lost = track(place, (0.1, 0.0), age=3.0, particles=cloud(place))
    assert check.aside(belief([lost]), 0.0, SPEED) == P.near_angle


def test_nothing_counts_beyond_the_farthest_ring(belief, track):
    bearing = REACH + 0.5 * P.near_angle
    place = (0.6 * cos(bearing), 0.6 * sin(bearing))
    lost = belief([track(place, (0.1, 0.0), age=3.0, particles=cloud(place))])
    ground = belief(age=lambda x, y: 9.0 if np.hypot(x, y) > 0.55 else 0.0)
    for rings, counts in (((0.4, 0.5), False), ((0.7, 0.4), True)):
        check = RearCheck(RearCheckParameters(rings=rings), REACH, 0.12, SPEED)
        for b in (lost, ground):
            assert check.urgency(b, 0.0, SPEED).any() == counts


def test_what_is_near_and_may_move_is_left_before_anything_is_looked_at(check, belief, track):
    far, near = (0.0, 0.12 + 0.08 + 1.1 * P.clearance), (0.0, 0.12 + 0.08 + 0.9 * P.clearance)

    def aside(place, motion):
        there = track(place, (0.0, 0.1), motion)
        return check.aside(belief([there], age=stale(beside)), 0.0, SPEED)

    for motion in (Motion.MOVING, Motion.UNKNOWN):
        assert aside(far, motion) == P.near_angle
        assert aside(near, motion) == 0.0
        assert check.look_request() is None
    assert aside(near, Motion.STATIC) == P.near_angle


def test_a_lost_mover_counts_by_the_share_of_it_that_may_be_there(check, belief, track):
    near = sector(P.near_angle)
    bearing = REACH + 0.5 * P.near_angle
    place, far = (0.5 * cos(bearing), 0.5 * sin(bearing)), (2.0, 0.0)

    def urgency(*weights):
        particles = ([place, far], np.zeros((2, 2)), weights)
        lost = track(place, (0.1, 0.0), age=0.5, particles=particles)
        return check.urgency(belief([lost]), 0.0, SPEED)[near]

    assert 0.0 < urgency(0.5, 0.5) == pytest.approx(0.5 * urgency(1.0, 0.0))
    assert urgency(0.0, 1.0) == 0.0
