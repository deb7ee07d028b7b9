"""Blind frames of a turning camera, and the gaze that keeps its direction."""

import numpy as np
import pytest

import hsr8
from navigation.decision import GazeDecision

KINEMATIC = ["robot.body=kinematic", "camera.source=analytic", "duration=1.5"]


class Shaking:
    """Gaze that turns from side to side without a rest."""

    def choose(self, belief, task, motion):
        return GazeDecision(pan=1.2 * np.sin(2.0 * belief.time), tilt=-0.5)


class Staring:
    """Gaze in one direction of the world."""

    def __init__(self, stabilized):
        self.stabilized = stabilized

    def choose(self, belief, task, motion):
        pan = np.clip(0.6 - belief.pose[2], -1.5, 1.5)
        return GazeDecision(pan=float(pan), tilt=-0.5, stabilized=self.stabilized)


def frames(gaze, *settings, scenario="course"):
    scene = hsr8.load_scenario(scenario, [*KINEMATIC, *settings], 3)
    with hsr8.Simulation(scene, 3, gaze=gaze) as simulation:
        for tick in simulation:
            if tick.record is not None and tick.record.frame is not None:
                yield tick.record.walking.camera, tick.record.frame


@pytest.mark.parametrize("camera", ["analytic", pytest.param("rendered", marks=pytest.mark.gl)])
def test_a_frame_is_blind_if_and_only_if_the_camera_turns_faster_than_the_threshold(camera):
    blind = []
    for pose, frame in frames(Shaking(), f"camera.source={camera}"):
        view = frame.measured.view
        assert view.blind == (pose.turn_rate > 0.8)
        if view.blind:
            assert frame.detections == frame.measured.observations == ()
            assert not (frame.belief.local_map.age <= 0.0).any()
            assert not any(track.visible for track in frame.belief.tracks)
        blind.append(view.blind)
    assert 0.2 < np.mean(blind) < 0.9


def test_a_higher_threshold_blinds_fewer_frames():
    counts = [
        sum(frame.measured.view.blind for _, frame in frames(Shaking(), f"camera.blind_above={a}"))
        for a in (0.4, 1.2, 10_000.0)
    ]
    assert counts[0] > counts[1] > counts[2] == 0


def test_a_panoramic_camera_is_never_blind():
    looks = frames(None, "camera.source=neck-reach", "navigation.gaze.mode=fixed")
    assert not any(frame.measured.view.blind for _, frame in looks)


def test_a_stabilized_gaze_keeps_its_direction_while_the_body_turns():
    def turning(stabilized):
        looks = frames(Staring(stabilized), "command.wz=0.8", "duration=2.3", scenario="walk")
        looks = [look for look in looks if 1.0 < look[1].time < 2.2]
        directions = [frame.belief.pose[2] + pose.pan for pose, frame in looks]
        return np.ptp(directions), np.mean([frame.measured.view.blind for _, frame in looks])

    spread, blind = turning(stabilized=True)
    assert spread < 0.1
    assert blind == 0.0
    assert turning(stabilized=False)[1] > 0.3
