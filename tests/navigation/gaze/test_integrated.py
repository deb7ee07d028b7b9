"""Votes of the partial evaluations, eqs. (5) and (6)."""

import numpy as np
import pytest

from navigation.gaze.grid import GazeGrid
from navigation.gaze.integrated import gaze_map, integrated_votes
from navigation.gaze.scene import GazeScene
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints
from navigation.scene import Scene

PAPER = NavigationParameters.paper()
SAMPLES = SamplePoints.polar(PAPER.evaluation, np.pi / 2)
NO_BEACONS = np.zeros((0, 2))


@pytest.fixture
def votes(task):
    def make(belief, target=(2.0, 0.0), beacons=NO_BEACONS):
        scene = Scene.of(belief, task(target), PAPER, body=np.zeros(3))
        return integrated_votes(GazeScene.of(scene, None, SAMPLES, beacons, PAPER), PAPER)

    return make


def test_without_obstacles_waypoint_and_map_vote(votes, belief):
    v = votes(belief(sigma=0.0), (2.0, 2.0))
    assert v.pan == pytest.approx([np.pi / 4])
    assert v.value == pytest.approx([PAPER.gaze.w_way])
    v = votes(belief(sigma=0.0, confidence=lambda x, y: float(y < 0.0)))
    assert v.pan[0] > 0.3
    assert v.value[0] == pytest.approx(PAPER.gaze.w_lm)


def test_the_votes_of_obstacles_are_a_mean(votes, belief, track):
    places = [(0.6, 0.1 * i) for i in range(4)]
    tracks = [track(x, (-0.1, 0.0), sigma=0.2, id=i) for i, x in enumerate(places)]
    value = votes(belief(tracks, sigma=0.0)).value
    assert value[-4:] == pytest.approx(PAPER.gaze.w_ob / 4)


def test_obstacles_and_beacons_share_the_vote_of_self_localization(votes, belief, track):
    beacons = np.array([[2.0, 0.5], [2.0, -0.5]])
    v = votes(belief(sigma=0.2), beacons=beacons)
    assert v.value[-2:] == pytest.approx(PAPER.gaze.w_sf / 2)
    assert v.tilt[-2:] == pytest.approx(0.0)
    v = votes(belief([track((0.6, 0.1))], sigma=0.2), beacons=beacons)
    assert v.value[-4:-1] == pytest.approx(PAPER.gaze.w_sf / 3)


def test_obstacles_and_beacons_together_do_not_exceed_one(votes, belief, track, view):
    """Everything at its largest and in one line of sight."""
    mover = track((2.2, 0.0), (-0.2, 0.0), sigma=1.0)
    b = belief([mover], sigma=0.2, confidence=lambda x, y: 0.0, camera=view(1.57, -0.44))
    v = votes(b, beacons=np.array([[4.0, 0.0]]))
    assert v.value.sum() == pytest.approx(1.0)
    assert gaze_map(v, GazeGrid.of(PAPER.gaze), (1.6, 2.0)).max() == pytest.approx(1.0)
