from math import pi

import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.belief.tracks import Tracks
from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.parameters.motion import LandmarkParameters, UnivectorParameters
from navigation.scene import extended_radius

P = UnivectorParameters()
LANDMARKS = LandmarkObstacles(
    {"far": (3.0, 0.0), "east": (0.8, 0.0), "west": (-0.7, 0.1)}, 0.05, LandmarkParameters()
)


def radius(track, velocity=(0.0, 0.0), motion=None, psi_sf=0.0, psi_ob=0.0):
    o = Tracks.of([track((1, 0), velocity, motion)])
    return float(extended_radius(o, psi_sf, np.array([psi_ob]), P)[0])


def test_a_still_certain_obstacle_has_the_sum_of_the_radii(track):
    assert radius(track) == pytest.approx(P.s_robot + P.margin + 0.08)


def test_it_grows_with_speed_and_with_each_uncertainty(track):
    base = radius(track)
    assert radius(track, (0.1, 0.0)) == pytest.approx(base + 0.1 * P.eta_vo)
    assert radius(track, psi_sf=0.4) == pytest.approx(base + 0.4 * P.eta_imp)
    assert radius(track, psi_ob=0.6) == pytest.approx(base + 0.6 * P.eta_imp)


def test_a_track_called_static_does_not_grow_with_its_noise(track):
    assert radius(track, (0.1, 0.0), Motion.STATIC) == radius(track)


def test_the_speed_of_the_robot_does_not_matter_at_fixed_evaluations(scene, belief, track):
    """|v_o| of (7) is the speed over ground; a certain track has psi_ob = 0."""
    b = belief([track((1.0, 0.0), (0.05, 0.0), sigma=0.0)])
    standing, walking = (scene(b, body=(v, 0.0, 0.0)).s_oe for v in (0.0, 0.2))
    assert walking == pytest.approx(standing)


def test_landmarks_come_first(scene, belief, track):
    tracks = [track((1.0, 1.0), id=4), track((-1.0, 0.5), (0.1, 0.0), id=7)]
    b = belief(tracks)
    s = scene(b, landmarks=LANDMARKS.near(b.pose[:2]))
    assert s.landmarks == 2
    assert [t.label for t in s.obstacles[: s.landmarks]] == ["east", "west"]
    assert s.obstacles.ids[s.landmarks :].tolist() == [4, 7]
    assert [t.id for t in s.belief.tracks] == [4, 7]
    none_near = scene(b, landmarks=LANDMARKS.near(np.array([0.0, 9.0])))
    assert (none_near.landmarks, none_near.obstacles.ids.tolist()) == (0, [4, 7])


def test_every_obstacle_has_its_own_evaluations(scene, belief, track):
    """Each element of psi_ob and S_oe is that of the obstacle alone, landmarks included."""
    rng = np.random.default_rng(0)
    tracks = [
        track(rng.uniform(-1.5, 1.5, 2), rng.normal(0.0, 0.1, 2), sigma=sigma, id=i)
        for i, sigma in enumerate(rng.uniform(0.0, 0.1, 6))
    ]
    near, body = LANDMARKS.near(np.zeros(2)), (0.15, 0.02, 0.1)
    together = scene(belief(tracks), body=body, landmarks=near)
    assert len(together.psi_ob) == len(together.s_oe) == len(together.obstacles) == 8
    assert 0.0 < together.psi_ob.max() <= 1.0
    alone = [scene(belief([t]), body=body) for t in together.obstacles]
    assert together.psi_ob == pytest.approx([float(s.psi_ob[0]) for s in alone])
    assert together.s_oe == pytest.approx([float(s.s_oe[0]) for s in alone])


def test_the_velocity_is_that_of_the_body_in_w(scene, belief):
    s = scene(belief(pose=(1.0, 2.0, pi / 2)), body=(0.2, 0.05, 0.3))
    assert s.velocity == pytest.approx([-0.05, 0.2])
