"""Scene of a gaze decision."""

import numpy as np
import pytest

from navigation.decision import MotionDecision
from navigation.gaze.scene import GazeScene
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints
from navigation.scene import Scene

P = NavigationParameters.extended()
SAMPLES = SamplePoints.polar(P.evaluation, np.pi / 2)
BEACONS = np.array([[2.9, 0.0], [-2.9, 0.0], [9.0, 0.0]])


@pytest.fixture
def scene(task):
    def make(belief, motion=None):
        body = np.zeros(3) if motion is None else motion.velocity
        return GazeScene.of(Scene.of(belief, task(), P, body=body), motion, SAMPLES, BEACONS, P)

    return make


def test_an_empty_fresh_world_asks_for_nothing(scene, belief):
    s = scene(belief(sigma=0.0, turn_sigma=0.0))
    assert (s.map.psi, s.psi_sf, s.psi_ob_max, s.psi_way) == (0.0, 0.0, 0.0, 1.0)


def test_psi_way_falls_before_an_obstacle_and_psi_ob_rises(scene, belief, track):
    far = scene(belief([track((1.5, 0), sigma=0.05)]))
    b = belief([track((0.5, 0), sigma=0.05)])
    near = scene(b, MotionDecision(np.array([0.2, 0.0, 0.0])))
    assert near.psi_way < far.psi_way == 1.0
    assert near.psi_ob_max > far.psi_ob_max == 0.0


def test_ground_in_view_is_not_counted(scene, belief, view):
    unseen = belief(confidence=lambda x, y: 0.0, camera=view(0.6, -0.5))
    s = scene(unseen)
    left = s.samples.bearing > 0.05
    assert s.map.counted[~left].sum() > s.map.counted[left].sum()


def test_the_course_is_that_of_the_planned_velocity_or_to_the_destination(scene, belief, task):
    aside = MotionDecision(np.array([0.0, 0.05, 0.0]))
    b = belief(pose=(0.0, 0.0, 0.4))
    assert scene(b, aside).course == pytest.approx(np.pi / 2)
    assert scene(b).course == scene(b, MotionDecision(np.zeros(3))).course == pytest.approx(-0.4)
