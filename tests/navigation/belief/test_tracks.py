"""Tracks as arrays, their classification and what is published of them."""

import numpy as np
import pytest

from compilation.record import record
from navigation.belief.belief import Motion
from navigation.belief.detections import DetectionRecord
from navigation.belief.tracked_object import (
    ObjectRecord,
    classify,
    correct,
    detection_reach,
    published,
    search_radius,
)
from navigation.belief.tracks import MOTIONS, Tracks, max_deviation
from navigation.parameters.belief import TrackingParameters


def test_max_deviation_is_that_of_the_eigenvalues_and_ignores_rotation():
    rng = np.random.default_rng(0)
    a = rng.normal(size=(50, 2, 2))
    p = a @ a.transpose(0, 2, 1)
    expected = np.sqrt(np.linalg.eigvalsh(p)[:, -1])
    assert [max_deviation(q) for q in p] == pytest.approx(expected)
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s], [s, c]])
    assert [max_deviation(q) for q in turn @ p @ turn.T] == pytest.approx(expected)


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
    objects = np.zeros(1, ObjectRecord)
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
    ("speed", "verdict"),
    [
        (P.min_moving_speed + 0.001, Motion.MOVING),
        (P.min_moving_speed - 0.001, Motion.UNKNOWN),
        (0.0, Motion.UNKNOWN),
    ],
)
def test_a_mover_that_has_stopped_is_undecided(speed, verdict):
    """At zero speed detections do not change the probabilities of the modes."""
    objects = make(filters(0.5, (speed, 0.0)), motion=Motion.MOVING)
    classify(objects[0], LIMITS[0])
    assert verdict_of(objects) is verdict


def test_a_mover_that_may_have_reversed_has_not_stopped():
    modes = filters(0.999, (0.1, 0.0))
    modes["weights"] = [0.001, 0.4995, 0.4995]
    modes["states"][2, 2:] *= -1.0
    objects = make(modes, motion=Motion.MOVING)
    classify(objects[0], LIMITS[0])
    assert track_of(objects, 5.0).velocity == pytest.approx([0.0, 0.0])
    assert verdict_of(objects) is Motion.MOVING


@pytest.mark.parametrize("last_time", [5.0, 9.99])
def test_a_detection_outside_the_gate_counts_once(last_time):
    """The filters start again at the detection, as those of a new track."""
    d = np.zeros(1, DetectionRecord)[0]
    d.position, d.covariance, d.radius, d.radius_sigma = (2.0, 2.0), SHARP, 0.08, 0.01
    objects = make(filters(0.7), motion=Motion.MOVING, last_time=last_time)
    o = objects[0]
    correct(o, d, 10.0, LIMITS[0])
    for state, covariance in zip(o.states, o.covariances, strict=True):
        assert state.tolist() == [2.0, 2.0, 0.0, 0.0, 0.0]
        assert np.array_equal(covariance[:2, :2], SHARP)
    assert 1.0 - o.weights[0] == pytest.approx(0.7)
    assert (o.hits, o.last_time) == (51, 10.0)
    assert track_of(objects, 10.0).covariance[2, 2] == pytest.approx(P.velocity_sigma**2)


def test_two_equally_certain_radii_are_averaged():
    d = np.zeros(1, DetectionRecord)[0]
    d.position, d.covariance, d.radius, d.radius_sigma = (0.95, 2.0), SHARP, 0.10, 0.02
    o = make(radius=0.08, radius_sigma=0.02)[0]
    correct(o, d, 100.0, LIMITS[0])  # so late that the errors are independent
    assert (o.radius, o.radius_sigma) == pytest.approx((0.09, 0.02 / np.sqrt(2.0)))


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
