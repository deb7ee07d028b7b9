"""Faults of the camera: the robot gets over each of them and is never wrong without knowing."""

import runpy
from pathlib import Path

import numpy as np
import pytest

from hsr8.loop import Simulation
from hsr8.recorder.record import Listener
from hsr8.scenario.loader import load_scenario
from vision.color_file import save_table
from vision.color_learning import learn

SURE = 0.12  # a pose farther from the truth than this must be known to be lost [m]
AGAIN = 0.06  # so near the truth the robot is again in the end [m]


def errors(recorded):
    """Distance of the believed from the true position at every frame [m]."""
    return np.array(
        [
            np.hypot(*(r.frame.belief.pose[:2] - r.truth.robot[:2]))
            for r in recorded.records
            if r.frame is not None
        ]
    )


def assert_got_over(outcome, recorded, reason):
    frames = recorded.frames
    assert outcome.exit_reason == reason
    assert all(np.isfinite(f.belief.pose).all() for f in frames)
    assert frames[-1].belief.filter_faults == 0
    wrong = errors(recorded) > SURE
    assert not any(w and not f.belief.lost for w, f in zip(wrong, frames, strict=True))
    assert np.median(errors(recorded)[-20:]) < AGAIN


EACH_FAULT = pytest.mark.parametrize(
    "setting",
    [
        'fault=[{kind="camera-black",start=2.0,duration=1.0}]',
        'fault=[{kind="missed-detections",magnitude=0.2}]',
        'fault=[{kind="false-detections",magnitude=0.5}]',
        'fault=[{kind="camera-drops",magnitude=0.2}]',
        'fault=[{kind="camera-latency",start=1.0,duration=2.0,magnitude=0.1}]',
        "camera.latency_ms=60",
    ],
    ids=[
        "black for 1 s",
        "a fifth missed",
        "false blobs",
        "a fifth dropped",
        "100 ms late for 2 s",
        "60 ms late",
    ],
)


@EACH_FAULT
def test_the_robot_gets_over(simulate, setting):
    outcome, recorded, _ = simulate("quick", setting, seed=1, duration=4.0)
    assert_got_over(outcome, recorded, "timeout")


@pytest.mark.slow
@pytest.mark.timeout(1800)
@EACH_FAULT
def test_the_robot_reaches_its_goal_in_spite_of(simulate, setting):
    outcome, recorded, _ = simulate("quick", setting, seed=1, duration=90.0)
    assert_got_over(outcome, recorded, "goal")


def test_nothing_is_seen_while_the_camera_is_black(simulate):
    black = 'fault=[{kind="camera-black",start=0.3,duration=0.6}]'
    _, recorded, _ = simulate("quick", black, duration=1.2)
    black = [f for f in recorded.frames if 0.3 <= f.time < 0.9]
    assert len(black) == 10
    assert not any(f.detections for f in black)
    assert any(f.detections for f in recorded.frames if f.time >= 0.9)


def test_late_frames_are_believed_at_their_capture(simulate):
    _, recorded, _ = simulate("quick", "camera.latency_ms=60", duration=1.0)
    for f in recorded.frames:
        assert f.measured.time == pytest.approx(f.time - 0.06)
        assert f.belief.time == pytest.approx(f.time)


@pytest.mark.gl
@pytest.mark.parametrize(
    "settings",
    [
        (
            'fault=[{kind="lighting",start=1.0,duration=1.0,magnitude=0.4},'
            '{kind="lighting",start=2.0,magnitude=1.6}]',
        ),
        ('fault=[{kind="camera-black",start=1.0,duration=1.0}]',),
        (
            'fault=[{kind="missed-detections",magnitude=0.2},{kind="false-detections",magnitude=1.0}]',
        ),
        ("camera.latency_ms=60", 'fault=[{kind="camera-drops",magnitude=0.2}]'),
    ],
    ids=["darker, then brighter", "black for 1 s", "missed and false", "late and dropped"],
)
def test_rendered_images_with_faults(simulate, settings):
    outcome, recorded, _ = simulate("quick", *settings, camera="rendered", seed=1, duration=3.0)
    assert_got_over(outcome, recorded, "timeout")


@pytest.mark.gl
def test_a_brightness_step_changes_the_image_and_not_what_is_seen(simulate):
    step = 'fault=[{kind="lighting",start=0.5,magnitude=0.4}]'
    _, steady, _ = simulate("quick", camera="rendered", duration=0.6)
    _, stepped, _ = simulate("quick", step, camera="rendered", duration=0.6)
    a, b = steady.frames[-1], stepped.frames[-1]
    assert b.image.mean() == pytest.approx(0.4 * a.image.mean(), rel=0.1)
    assert [d.label for d in a.detections] == [d.label for d in b.detections]


@pytest.mark.gl
def test_a_table_learnt_from_rendered_images_sees_as_well_as_the_declared_one(tmp_path):
    script = Path(__file__).parents[2] / "scripts" / "label_images.py"
    labelled = runpy.run_path(str(script))["labelled"]
    marks = runpy.run_path(str(script))["mask_colors"]()
    pairs = []
    for pan in (-0.9, -0.3, 0.3, 0.9):
        image, mask = labelled(0, pan, -0.3)
        labels = np.zeros(mask.shape[:2], np.uint8)
        for label, rgb in enumerate(marks.values(), start=1):
            labels[(mask == rgb).all(axis=2)] = label
        pairs.append((image, labels))
    save_table(learn(pairs), tmp_path / "colours.npz")
    counts = []
    for setting in ([], [f"vision.color_table={tmp_path / 'colours.npz'}"]):
        seen = []

        class Counter(Listener):
            def on_record(self, record, seen=seen):
                if record.frame is not None:
                    seen.append(sorted(d.label for d in record.frame.detections))

        scenario = load_scenario("course", ["duration=0.6", 'robot.body="kinematic"', *setting])
        Simulation(scenario, 3, [Counter()]).run()
        counts.append(seen)
    declared, learnt = counts
    assert sum(map(len, declared)) > 20
    same = sum(a == b for a, b in zip(declared, learnt, strict=True))
    assert same >= 0.9 * len(declared)
