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


def lateral(bearing):
    return REACH - EDGE < bearing < REACH + P.near_angle + EDGE


def behind(bearing):
    return abs(bearing) > REACH + P.near_angle - EDGE


def sector(angle):
    return [s.body_angle for s in sectors(P, REACH)].index(angle)


def cloud(point):
    return ([point], [[0.0, 0.0]], [1.0])


def test_sectors_and_reach_of_the_gaze_cover_the_circle():
    result = sectors(P, REACH)
    for bearing in np.linspace(-pi, pi, 181):
        covered = [abs(wrap(bearing - s.middle)) <= s.half_width for s in result]
        assert any(covered) or abs(bearing) <= REACH + 1e-9


def test_the_turned_body_has_the_whole_sector_in_reach():
    for s in sectors(P, REACH):
        assert np.abs(s.bearing - s.body_angle).max() == pytest.approx(REACH)


def test_fresh_ground_needs_no_turn(check, belief):
    assert check.body_angle(belief(), 0.0, SPEED) == 0.0
    assert check.look_request() is None


@pytest.mark.parametrize("side", [1, -1])
def test_stale_ground_turns_the_body_to_its_side(side, belief):
    for inside, angle in ((lateral, P.near_angle), (behind, P.far_angle)):
        check = RearCheck(P, REACH, 0.12, SPEED)
        b = belief(age=stale(lambda bearing, i=inside: bearing * side > 0 and i(side * bearing)))
        assert check.body_angle(b, 0.0, 0.03) == side * angle
        request = check.look_request()
        assert np.sign(request) == side
        assert abs(wrap(request - side * angle)) < REACH


def test_the_angle_does_not_depend_on_the_frame(belief):
    pose, course = (2.0, -1.0, 0.4), 1.1
    path = (*pose[:2], course)
    here = RearCheck(P, REACH, 0.12, SPEED)
    there = RearCheck(P, REACH, 0.12, SPEED)
    one = here.body_angle(belief(age=stale(lateral)), 0.0, SPEED)
    other = there.body_angle(belief(pose=pose, age=stale(lateral, path)), course, SPEED)
    assert one == pytest.approx(other) == P.near_angle
    assert there.look_request() == pytest.approx(here.look_request() + course)


def test_the_sector_stays_until_it_was_seen(check, belief):
    both = stale(lambda bearing: lateral(abs(bearing)))
    first = check.body_angle(belief(age=both), 0.0, SPEED)
    right = stale(lambda bearing: lateral(-bearing))
    assert check.body_angle(belief(age=both, time=1.0), 0.0, SPEED) == first
    assert check.body_angle(belief(age=right, time=1.4), 0.0, SPEED) == -first
    assert check.body_angle(belief(time=1.8), 0.0, SPEED) == 0.0


@pytest.mark.parametrize("side", [1, -1])
def test_the_sector_is_fixed_in_the_world_when_the_course_turns(check, belief, side):
    stale_side = stale(lambda bearing: lateral(side * bearing))
    assert check.body_angle(belief(age=stale_side), 0.0, SPEED) == side * P.near_angle
    request = check.look_request()
    for course in (0.1, -0.1, 0.3, 0.0):
        angle = check.body_angle(belief(age=stale_side, time=0.4), course, SPEED)
        assert check.look_request() == request
        assert course + angle == pytest.approx(side * P.near_angle)
    # A course towards the sector needs no offset; away from it the offset is limited.
    assert check.body_angle(belief(age=stale_side, time=0.4), side * 1.0, SPEED) == 0.0
    away = check.body_angle(belief(age=stale_side, time=0.4), -side * 2.0, SPEED)
    assert away == side * P.far_angle


def test_a_failed_check_is_retried_after_a_delay(check, belief):
    def at(time):
        return check.body_angle(belief(age=stale(lateral), time=time), 0.0, SPEED)

    late = P.max_turn_time + 0.1
    assert at(0.0) == P.near_angle
    assert at(P.max_turn_time) == P.near_angle
    assert at(late) == 0.0
    assert at(late + 0.9 * P.retry_delay) == 0.0
    assert at(late + 1.1 * P.retry_delay) == P.near_angle


def test_ground_right_behind_is_more_urgent_for_a_slower_robot(check, belief):
    index = sector(P.far_angle)
    b = belief(age=stale(behind, age=2.0))
    urgency = [check.urgency(b, 0.0, v)[index] for v in (0.0, 0.05, 0.1, 0.2)]
    assert np.all(np.diff(urgency) < 0.0)


def test_a_lost_mover_behind_turns_the_body_and_a_visible_one_does_not(check, belief, track):
    bearing = REACH + 0.5 * P.near_angle
    point = (0.5 * cos(bearing), 0.5 * sin(bearing))
    visible = track(point, (0.1, 0.0), age=0.1)
    assert check.body_angle(belief([visible]), 0.0, SPEED) == 0.0
    lost = track(point, (0.1, 0.0), age=3.0, particles=cloud(point))
    assert check.body_angle(belief([lost]), 0.0, SPEED) == P.near_angle


def test_nothing_counts_beyond_the_farthest_ring(belief, track):
    bearing = REACH + 0.5 * P.near_angle
    point = (0.6 * cos(bearing), 0.6 * sin(bearing))
    lost = belief([track(point, (0.1, 0.0), age=3.0, particles=cloud(point))])
    ground = belief(age=lambda x, y: 9.0 if np.hypot(x, y) > 0.55 else 0.0)
    for rings, counts in (((0.4, 0.5), False), ((0.7, 0.4), True)):
        check = RearCheck(RearCheckParameters(rings=rings), REACH, 0.12, SPEED)
        for b in (lost, ground):
            assert check.urgency(b, 0.0, SPEED).any() == counts


def test_near_non_static_tracks_prevent_the_check(check, belief, track):
    far, near = (0.0, 0.12 + 0.08 + 1.1 * P.clearance), (0.0, 0.12 + 0.08 + 0.9 * P.clearance)

    def angle(point, motion):
        there = track(point, (0.0, 0.1), motion)
        return check.body_angle(belief([there], age=stale(lateral)), 0.0, SPEED)

    for motion in (Motion.MOVING, Motion.UNKNOWN):
        assert angle(far, motion) == P.near_angle
        assert angle(near, motion) == 0.0
        assert check.look_request() is None
    assert angle(near, Motion.STATIC) == P.near_angle


def test_a_lost_mover_counts_by_the_weight_of_its_particles(check, belief, track):
    near = sector(P.near_angle)
    bearing = REACH + 0.5 * P.near_angle
    point, far = (0.5 * cos(bearing), 0.5 * sin(bearing)), (2.0, 0.0)

    def urgency(*weights):
        particles = ([point, far], np.zeros((2, 2)), weights)
        lost = track(point, (0.1, 0.0), age=0.5, particles=particles)
        return check.urgency(belief([lost]), 0.0, SPEED)[near]

    assert 0.0 < urgency(0.5, 0.5) == pytest.approx(0.5 * urgency(1.0, 0.0))
    assert urgency(0.0, 1.0) == 0.0
