import numpy as np
import pytest

from navigation.belief.belief import Motion, Particles
from navigation.belief.imm import Modes
from navigation.belief.imm_kernel import estimates
from navigation.belief.tracked_object import TrackedObject, reach_of
from navigation.parameters.belief import TrackingParameters

P = TrackingParameters()
SHARP = 1e-4 * np.eye(2)


def filters(moving=0.5, velocity=(0.03, 0.0)):
    """Stands still at (0.9, 2) or goes on from (1, 2)."""
    walks = [1.0, 2.0, *velocity, 0.2]
    states = np.array([[0.9, 2.0, 0.0, 0.0, 0.0], walks, walks])
    covariances = np.stack([np.diag([1e-4, 1e-4, 0.0, 0.0, 0.0])] + 2 * [np.eye(5) * 1e-3])
    return Modes(np.array([1.0 - moving, moving, 0.0]), states, covariances)


def make(**changes):
    values = {
        "id": 3,
        "label": "red",
        "radius": 0.08,
        "radius_sigma": 0.01,
        "first_time": 0.0,
        "last_time": 5.0,
        "last_seen": np.array([1.0, 2.0]),
        "reach_at_detection": reach_of(np.eye(2) * 1e-4, P),
        "hits": 50,
    }
    return TrackedObject(**(values | changes))


def published(o, time, modes=None, best=SHARP):
    """The track that becomes of it and of what its filters say."""
    rows = Modes(*(part[None] for part in modes or filters()))
    static = np.array([o.motion is Motion.STATIC])
    bias, speed = P.bias_fraction**2, P.static_velocity_sigma**2
    moments = estimates(*rows, static, best[None], bias, speed)
    return o.track(time, P, tuple(part[0] for part in moments))


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
    o = make(motion=motion)
    o.classify(filters(moving), P)
    assert o.motion is verdict


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
    o = make(**changes)
    o.classify(modes, P)
    assert o.motion is Motion.UNKNOWN


def test_each_verdict_publishes_its_own_filter():
    moving = published(make(motion=Motion.MOVING), 5.0)
    assert moving.position.tolist() == [1.0, 2.0]
    assert moving.velocity.tolist() == [0.03, 0.0]
    assert moving.turn_rate == 0.2
    static = published(make(motion=Motion.STATIC), 5.5)
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
        assert published(o, 5.0).reach == pytest.approx(known)
        assert published(o, 8.0).reach == pytest.approx(known + 3.0 * growth)


def test_the_reach_does_not_depend_on_the_axes_of_the_world():
    reach = []
    for turn in (0.0, 0.4, 0.8, 2.0):
        c, s = np.cos(turn), np.sin(turn)
        Q = np.array([[c, -s], [s, c]])
        reach.append(reach_of(Q @ np.diag([9e-4, 1e-6]) @ Q.T, P))
    assert np.allclose(reach, P.reach_sigmas * 0.03)


def test_the_search_radius_grows_with_speed():
    for speed in (0.0, 0.03, 0.2):
        o, modes = make(), filters(1.0, (speed, 0.0))
        assert o.search_radius(5.0, modes, P) == P.path_width
        farther = P.path_width + 4.0 * P.reach_factor * speed
        assert o.search_radius(9.0, modes, P) == pytest.approx(farther)


def test_a_cloud_is_published_by_its_moments():
    cloud = Particles(
        np.array([[0.0, 0.0], [1.0, 0.0]]),
        np.array([[0.1, 0.0], [-0.1, 0.0]]),
        np.array([0.1, -0.3]),
        np.array([0.25, 0.75]),
    )
    track = published(make(motion=Motion.MOVING, particles=cloud), 8.0)
    assert np.allclose(track.position, [0.75, 0.0])
    assert np.allclose(track.velocity, [-0.05, 0.0])
    assert track.turn_rate == pytest.approx(-0.2)
    assert track.covariance[0, 0] == pytest.approx(0.1875)


def test_a_published_track_does_not_change_later():
    o, modes = make(motion=Motion.MOVING), filters()
    track = published(o, 5.0, modes)
    modes.states[:] = 0.0
    modes.covariances[:] = 0.0
    o.last_seen[:] = 0.0
    assert track.position.tolist() == [1.0, 2.0]
    assert track.covariance[0, 0] == pytest.approx(1e-3)
    assert track.last_seen.tolist() == [1.0, 2.0]
