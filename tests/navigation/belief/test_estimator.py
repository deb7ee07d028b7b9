import pickle

import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.belief.estimator import Estimator
from navigation.parameters.belief import BeliefParameters

BEACONS = {"a/b": (3.0, 0.0), "b/a": (2.0, 2.0), "a/c": (2.0, -2.0)}
STATIC, MOVER = (1.2, 0.3), (1.5, -0.5)


def frames(view, observe, frame, seconds, seed=0, kidnapped_at=np.inf):
    rng = np.random.default_rng(seed)
    for k in range(1, int(seconds / 0.06)):
        t = 0.06 * k
        x = 0.05 * np.sin(t)
        pose = (x, 0.0, 0.05 * np.sin(0.7 * t))
        truth = pose if t < kidnapped_at else (x + 0.5, 0.6, pose[2] - 0.5)
        pan = 0.2 * np.sin(t)
        observed = [
            observe(truth, p, kind="beacon", label=n, noise=rng.normal(0, [0.05, 0.01]),
                    sigma=(0.05, 0.01))
            for n, p in BEACONS.items()
        ]  # fmt: skip
        for label, p in (("red", STATIC), ("blue", (MOVER[0], MOVER[1] + 0.1 * t))):
            observed.append(observe(truth, p, label=label, noise=rng.normal(0, [0.02, 0.01])))
        yield frame(t, pose, observed, view(pan=pan))


def estimator(seed=0):
    return Estimator(
        BeliefParameters(), BEACONS, np.zeros(3), np.eye(3) * 4e-4, np.random.default_rng(seed)
    )


@pytest.fixture
def beliefs(view, observe, frame):
    e = estimator()
    return [e.update(f) for f in frames(view, observe, frame, 6.0)]


def test_frames_become_a_belief(beliefs):
    last = beliefs[-1]
    red, blue = sorted(last.tracks, key=lambda t: t.label, reverse=True)
    assert np.hypot(*last.pose[:2]) < 0.1
    assert np.hypot(*(red.position - STATIC)) < 0.05
    assert red.motion is Motion.STATIC
    assert blue.motion is Motion.MOVING
    assert np.hypot(*(blue.velocity - (0.0, 0.1))) < 0.04
    assert set(last.seen_beacons) == set(BEACONS)
    assert last.local_map.confidence_at([STATIC])[0] == 1.0
    assert not last.local_map.free_at([STATIC])[0]
    assert last.filter_faults == 0
    assert not last.lost


def test_a_belief_is_a_snapshot(view, observe, frame):
    e = estimator()
    early, frozen = None, None
    for k, f in enumerate(frames(view, observe, frame, 6.0)):
        belief = e.update(f)
        if k == 50:
            early, frozen = belief, pickle.dumps(belief)
    assert pickle.dumps(early) == frozen
    assert frozen != pickle.dumps(belief)


def test_kidnapped_the_robot_finds_itself_and_its_obstacles_again(view, observe, frame):
    e = estimator()
    lost = 0
    for f in frames(view, observe, frame, 8.0, kidnapped_at=4.0):
        belief = e.update(f)
        lost += belief.lost
    assert 0 < lost < 40
    assert not belief.lost
    assert np.hypot(*(belief.pose[:2] - (0.5, 0.6))) < 0.1
    red = [t for t in belief.tracks if t.label == "red"]
    assert len(red) == 1
    assert np.hypot(*(red[0].position - STATIC)) < 0.08


def test_nonsense_in_frames_does_no_lasting_harm(view, observe, frame):
    """Random blobs of all kinds: no exception, no NaN, covariances stay positive."""
    rng = np.random.default_rng(0)
    e = estimator()
    time, odometry = 0.0, np.zeros(3)
    for _ in range(150):
        time += float(rng.choice([0.005, 0.06, 0.06, 3.0]))
        odometry += rng.normal(0, [0.05, 0.05, 0.3])
        observed = [
            observe(
                np.zeros(3),
                tuple(rng.uniform(-2.5, 2.5, 2).tolist()),
                kind=kind,
                label=str(rng.choice(["a/b", "b/a", "x/y", "red", "blue"])),
                sigma=tuple(rng.uniform(1e-3, 0.3, 2).tolist()),
                cut=bool(rng.random() < 0.3),
                occluded=bool(rng.random() < 0.3),
            )
            for kind in rng.choice(["obstacle", "beacon"], int(rng.integers(0, 12)))
        ]
        camera = view(pan=rng.uniform(-1.5, 1.5), tilt=rng.uniform(-1.0, 0.3))
        belief = e.update(frame(time, odometry, observed, camera))
        assert np.isfinite(belief.pose).all()
        assert np.linalg.eigvalsh(belief.pose_covariance)[0] > 0
        assert len({t.id for t in belief.tracks}) == len(belief.tracks)
        for t in belief.tracks:
            assert np.isfinite(t.position).all()
            assert np.isfinite(t.velocity).all()
            assert np.linalg.eigvalsh(t.covariance)[0] > -1e-9
            assert t.particles is None or t.particles.weights.sum() == pytest.approx(1.0)
    for f in frames(view, observe, frame, 6.0):
        good = frame(time + f.time, odometry + f.odometry * [1, 1, 1], f.observations, f.view)
        belief = e.update(good)
    assert np.hypot(*belief.pose[:2]) < 0.15
    assert not belief.lost
