import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.belief.tracked_object import (
    OBJECT,
    classify,
    detection_reach,
    published,
    search_radius,
)
from navigation.belief.tracks import MOTIONS, Tracks
from navigation.parameters.belief import TrackingParameters
from navigation.record import record

P = TrackingParameters()
LIMITS = record(P)
SHARP = 1e-4 * np.eye(2)


def filters(moving=0.5, velocity=(0.03, 0.0)):
    """Stands still at (0.9, 2) or goes on from (1, 2)."""
    walks = [1.0, 2.0, *velocity, 0.2]
    return {
        "weights": [1.0 - moving, moving, 0.0],
        "states": np.array([[0.9, 2.0, 0.0, 0.0, 0.0], walks, walks]),
        "covariances": np.stack([np.diag([1e-4, 1e-4, 0.0, 0.0, 0.0])] + 2 * [np.eye(5) * 1e-3]),
    }


def make(modes=None, **changes):
    values = {
        "id": 3,
        "radius": 0.08,
        "radius_sigma": 0.01,
        "first_time": 0.0,
        "last_time": 5.0,
        "last_seen": np.array([1.0, 2.0]),
        "detection_reach": detection_reach(SHARP, LIMITS[0]),
        "best": SHARP,
        "motion": Motion.UNKNOWN,
        "hits": 50,
    }
    values |= (modes or filters()) | changes
    values["motion"] = MOTIONS.index(values["motion"])
    objects = np.zeros(1, OBJECT)
    for name, value in values.items():
        objects[name] = value
    return objects


def verdict_of(objects):
    return MOTIONS[int(objects["motion"][0])]


def track_of(objects, time, cloud=None):
    """The published track."""
    clouds = np.zeros((1, 6, 2)) if cloud is None else cloud[None]
    (track,) = Tracks(*published(objects, clouds, time, LIMITS), ("red",))
    return track


@pytest.mark.parametrize(
    ("motion", "moving", "verdict"),
    [
        (Motion.UNKNOWN, P.moving_probability + 0.001, Motion.MOVING),
        (Motion.UNKNOWN, P.moving_probability - 0.001, Motion.UNKNOWN),
        (Motion.UNKNOWN, P.static_probability - 0.001, Motion.STATIC),
        (Motion.UNKNOWN, P.static_probability + 0.001, Motion.UNKNOWN),
        (Motion.STATIC, P.static_exit_probability - 0.001, Motion.STATIC),
        (Motion.STATIC, P.static_exit_probability + 0.001, Motion.UNKNOWN),
        (Motion.MOVING, P.moving_exit_probability + 0.001, Motion.MOVING),
        (Motion.MOVING, P.moving_exit_probability - 0.001, Motion.STATIC),
    ],
)
def test_verdicts_have_hysteresis(motion, moving, verdict):
    objects = make(filters(moving), motion=motion)
    classify(objects[0], LIMITS[0])
    assert verdict_of(objects) is verdict


@pytest.mark.parametrize(
    ("modes", "changes"),
    [
        (filters(0.999), {"hits": 3}),
        (filters(0.999, (0.01, 0.0)), {}),
        (filters(0.001), {"hits": 5}),
        (filters(0.001), {"first_time": 3.5}),
    ],
)
def test_probability_alone_is_not_enough(modes, changes):
    objects = make(modes, **changes)
    classify(objects[0], LIMITS[0])
    assert verdict_of(objects) is Motion.UNKNOWN


def test_each_verdict_publishes_its_own_filter():
    moving = track_of(make(motion=Motion.MOVING), 5.0)
    assert moving.position.tolist() == [1.0, 2.0]
    assert moving.velocity.tolist() == [0.03, 0.0]
    assert moving.turn_rate == 0.2
    static = track_of(make(motion=Motion.STATIC), 5.5)
    assert static.position.tolist() == [0.9, 2.0]
    assert static.velocity.tolist() == [0.0, 0.0]
    assert static.turn_rate == 0.0
    assert np.allclose(static.covariance[2:, 2:], P.static_velocity_sigma**2 * np.eye(2))
    assert static.age == pytest.approx(0.5)
    assert np.linalg.eigvalsh(static.covariance)[0] > 0
    assert moving.visible
    assert not static.visible


def test_the_reach_grows_with_age_unless_static():
    for motion, growth in ((Motion.STATIC, 0.0), (Motion.MOVING, P.max_speed)):
        o = make(motion=motion)
        known = P.reach_sigmas * 0.01
        assert track_of(o, 5.0).reach == pytest.approx(known)
        assert track_of(o, 8.0).reach == pytest.approx(known + 3.0 * growth)


def test_the_reach_does_not_depend_on_the_axes_of_the_world():
    reach = []
    for turn in (0.0, 0.4, 0.8, 2.0):
        c, s = np.cos(turn), np.sin(turn)
        Q = np.array([[c, -s], [s, c]])
        reach.append(detection_reach(Q @ np.diag([9e-4, 1e-6]) @ Q.T, LIMITS[0]))
    assert np.allclose(reach, P.reach_sigmas * 0.03)


def test_the_search_radius_grows_with_speed():
    for speed in (0.0, 0.03, 0.2):
        o = make(filters(1.0, (speed, 0.0)))[0]
        assert search_radius(o, 5.0, LIMITS[0]) == P.path_width
        farther = P.path_width + 4.0 * P.reach_factor * speed
        assert search_radius(o, 9.0, LIMITS[0]) == pytest.approx(farther)


def test_a_cloud_is_published_by_its_moments():
    cloud = np.array([[0.0, 1.0], [0.0, 0.0], [0.1, -0.1], [0.0, 0.0], [0.1, -0.3], [0.25, 0.75]])
    track = track_of(make(motion=Motion.MOVING, lost=True), 8.0, cloud)
    assert np.allclose(track.position, [0.75, 0.0])
    assert np.allclose(track.velocity, [-0.05, 0.0])
    assert track.turn_rate == pytest.approx(-0.2)
    assert track.covariance[0, 0] == pytest.approx(0.1875)
    assert np.array_equal(track.particles.positions, cloud[:2].T)
