import numpy as np
import pytest

from navigation.gaze.information import (
    ground_information,
    pose_information,
    sight_sigma,
    track_information,
)
from navigation.gaze.scene import gaze_scene
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints

P = NavigationParameters.extended()
SAMPLES = SamplePoints.polar(P.evaluation, P.gaze.max_pan)


def scene(b, beacons=((2.0, 0.0),)):
    return gaze_scene(b, None, SAMPLES, np.array(beacons, float).reshape(-1, 2), P)


def test_the_gain_of_a_track_is_the_entropy_reduction_by_one_detection(belief, track):
    b = belief([track((1.0, 0.0), (0.1, 0.0), sigma=0.1)])
    prior = b.tracks[0].covariance[:2, :2]
    noise = np.eye(2) * sight_sigma(np.ones(1), P)[0] ** 2
    posterior = np.linalg.inv(np.linalg.inv(prior) + np.linalg.inv(noise))
    entropy = 0.5 * (np.linalg.slogdet(prior)[1] - np.linalg.slogdet(posterior)[1])
    (gain,) = track_information(scene(b), P).value
    assert gain == pytest.approx(entropy)


def test_the_gain_of_a_cloud_is_split_over_its_particles(belief, track):
    places, still = [[1.0, 0.5], [1.0, -0.5]], np.zeros((2, 2))
    lost = belief([track((1.0, 0.0), (0.1, 0), age=3.0, particles=(places, still, [0.7, 0.3]))])
    votes = track_information(scene(lost), P)
    assert votes.value[0] / votes.value[1] == pytest.approx(0.7 / 0.3)
    assert votes.pan == pytest.approx([np.arctan2(0.5, 1.0), -np.arctan2(0.5, 1.0)])


def test_the_gain_of_a_beacon_is_that_of_the_pose(belief):
    b = belief(sigma=0.05, turn_sigma=0.03)
    H = np.array([[-1.0, 0.0, 0.0], [0.0, -1.0, -2.0]])
    noise = np.eye(2) * sight_sigma(np.full(1, 2.0), P)[0] ** 2
    S = H @ b.pose_covariance @ H.T + noise
    (gain,) = pose_information(scene(b), P).value
    assert gain == pytest.approx(0.5 * np.log(np.linalg.det(S) / np.linalg.det(noise)))
    sure = belief(sigma=0.0, turn_sigma=0.0)
    assert pose_information(scene(sure), P).value == pytest.approx([0.0])


def test_gains_are_invariant_to_rotation(belief, track):
    def gains(turn):
        c, s = np.cos(turn), np.sin(turn)
        R = np.array([[c, -s], [s, c]])
        b = belief([track(R @ [1.0, 0.4], R @ [0.1, 0.0], sigma=0.1)], pose=(0.0, 0.0, turn))
        sc = scene(b, (R @ [2.0, 0.3],))
        return np.concatenate([track_information(sc, P).value, pose_information(sc, P).value])

    assert gains(1.1) == pytest.approx(gains(0.0))


def test_the_gain_of_unseen_ground_is_the_entropy_of_presence(belief):
    fresh, never = belief(), belief(confidence=lambda x, y: 0.0)
    assert ground_information(scene(fresh), P).value.max() < 1e-6
    q = P.gaze.information.presence
    entropy = -q * np.log(q) - (1 - q) * np.log(1 - q)
    assert ground_information(scene(never), P).value == pytest.approx(entropy)
