import numpy as np
import pytest

from navigation.belief import Motion, Particles
from navigation.belief_parameters import TrackingParameters
from navigation.tracked_object import TrackedObject

P = TrackingParameters()


def make(**changes):
    values = {
        "id": 3,
        "label": "red",
        "state": np.array([1.0, 2.0, 0.03, 0.0]),
        "covariance": np.eye(4) * 1e-3,
        "still": np.array([0.9, 2.0]),
        "still_covariance": np.eye(2) * 1e-4,
        "radius": 0.08,
        "radius_sigma": 0.01,
        "first_time": 0.0,
        "last_time": 5.0,
        "last_seen": np.array([1.0, 2.0]),
        "hits": 50,
    }
    return TrackedObject(**(values | changes))


@pytest.mark.parametrize(
    ("motion", "evidence", "verdict"),
    [
        (Motion.UNKNOWN, 2.6, Motion.MOVING),
        (Motion.UNKNOWN, 2.4, Motion.UNKNOWN),
        (Motion.UNKNOWN, -3.1, Motion.STATIC),
        (Motion.UNKNOWN, -2.9, Motion.UNKNOWN),
        (Motion.STATIC, 1.2, Motion.STATIC),
        (Motion.STATIC, 1.3, Motion.UNKNOWN),
        (Motion.MOVING, -3.9, Motion.MOVING),
        (Motion.MOVING, -4.1, Motion.STATIC),
    ],
)
def test_verdicts_have_hysteresis(motion, evidence, verdict):
    o = make(motion=motion, evidence=evidence)
    o.classify(P)
    assert o.motion is verdict


@pytest.mark.parametrize(
    "changes",
    [
        {"evidence": 6.0, "hits": 3},
        {"evidence": 6.0, "state": np.array([0.0, 0.0, 0.01, 0.0])},
        {"evidence": -5.0, "hits": 5},
        {"evidence": -5.0, "first_time": 3.5},
        {"evidence": -5.0, "state": np.array([0.0, 0.0, 0.0, 0.05])},
    ],
)
def test_evidence_alone_is_not_enough(changes):
    o = make(**changes)
    o.classify(P)
    assert o.motion is Motion.UNKNOWN


def test_each_verdict_publishes_its_own_filter():
    moving = make(motion=Motion.MOVING).track(5.0)
    assert moving.position.tolist() == [1.0, 2.0]
    assert moving.velocity.tolist() == [0.03, 0.0]
    static = make(motion=Motion.STATIC).track(5.5)
    assert static.position.tolist() == [0.9, 2.0]
    assert static.velocity.tolist() == [0.0, 0.0]
    assert static.age == pytest.approx(0.5)
    assert np.linalg.eigvalsh(static.covariance)[0] > 0
    assert moving.visible
    assert not static.visible


def test_a_cloud_is_published_by_its_moments():
    cloud = Particles(
        np.array([[0.0, 0.0], [1.0, 0.0]]),
        np.array([[0.1, 0.0], [-0.1, 0.0]]),
        np.array([0.25, 0.75]),
    )
    track = make(motion=Motion.MOVING, particles=cloud).track(8.0)
    assert np.allclose(track.position, [0.75, 0.0])
    assert np.allclose(track.velocity, [-0.05, 0.0])
    assert track.covariance[0, 0] == pytest.approx(0.1875)
    assert track.position_sigma == pytest.approx(0.1875**0.5)


def test_what_is_published_does_not_change_later():
    o = make(motion=Motion.MOVING)
    track = o.track(5.0)
    o.state[:] = 0.0
    o.covariance[:] = 0.0
    o.last_seen[:] = 0.0
    assert track.position.tolist() == [1.0, 2.0]
    assert track.covariance[0, 0] == 1e-3
    assert track.last_seen.tolist() == [1.0, 2.0]
