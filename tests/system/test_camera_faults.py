"""Camera faults: the robot recovers from each, and a wrong belief is known to be lost."""

import numpy as np
import pytest

from hsr8.cli.color_table import mask_colors
from tests.system.labelled_images import labelled
from vision.color import save_table
from vision.color_learning import learn

MAX_ERROR = 0.12  # position error beyond which the belief must be lost [m]
FINAL_ERROR = 0.06  # median position error at the end [m]
FAULTS = {
    "black for 1 s": ['fault=[{kind="camera-black",start=1.0,duration=1.0}]'],
    "20 % missed": ['fault=[{kind="missed-detections",magnitude=0.2}]'],
    "false blobs": ['fault=[{kind="false-detections",magnitude=0.5}]'],
    "20 % dropped": ['fault=[{kind="camera-drops",magnitude=0.2}]'],
    "100 ms late": ['fault=[{kind="camera-latency",start=0.5,duration=1.5,magnitude=0.1}]'],
}
RENDERED = {
    "darker, then brighter": [
        'fault=[{kind="lighting",start=1.0,duration=1.0,magnitude=0.4},'
        '{kind="lighting",start=2.0,magnitude=1.6}]'
    ],
    "black for 1 s": ['fault=[{kind="camera-black",start=1.0,duration=1.0}]'],
    "missed and false": [
        'fault=[{kind="missed-detections",magnitude=0.2},{kind="false-detections",magnitude=1.0}]'
    ],
    "late and dropped": [
        "camera.latency_ms=60",
        'fault=[{kind="camera-drops",magnitude=0.2}]',
    ],
}


def assert_recovered(outcome, recorded, reason):
    frames = [(r.frame, r.truth) for r in recorded.records if r.frame is not None]
    errors = np.array([np.hypot(*(f.belief.pose - t.robot)[:2]) for f, t in frames])
    lost = np.array([f.belief.lost for f, _ in frames])
    assert outcome.exit_reason == reason
    assert np.isfinite(errors).all()
    assert frames[-1][0].belief.filter_faults == 0
    assert lost[errors > MAX_ERROR].all()
    assert np.median(errors[-20:]) < FINAL_ERROR


@pytest.mark.parametrize(
    ("duration", "reason"),
    [
        (3.2, "timeout"),
        pytest.param(90.0, "goal", marks=[pytest.mark.slow, pytest.mark.timeout(1800)]),
    ],
)
@pytest.mark.parametrize("fault", FAULTS)
def test_the_robot_recovers_from(simulate, fault, duration, reason):
    outcome, recorded, _ = simulate("quick", *FAULTS[fault], seed=1, duration=duration)
    assert_recovered(outcome, recorded, reason)


@pytest.mark.gl
@pytest.mark.parametrize("fault", RENDERED)
def test_the_robot_recovers_with_rendered_images_from(simulate, fault):
    settings = RENDERED[fault]
    outcome, recorded, _ = simulate("quick", *settings, camera="rendered", seed=1, duration=3.0)
    assert_recovered(outcome, recorded, "timeout")


def test_a_black_camera_detects_nothing(simulate):
    fault = 'fault=[{kind="camera-black",start=0.3,duration=0.6}]'
    _, recorded, _ = simulate("quick", fault, "navigation.gaze.mode=fixed", duration=1.2)
    black = [f for f in recorded.frames if 0.3 <= f.time < 0.9]
    assert len(black) == 10
    assert not any(f.detections for f in black)
    assert any(f.detections for f in recorded.frames if f.time >= 0.9)


def test_late_frames_are_predicted_to_the_present(simulate):
    _, recorded, _ = simulate("quick", "camera.latency_ms=60", duration=1.0)
    for f in recorded.frames:
        assert f.measured.time == pytest.approx(f.time - 0.06)
        assert f.belief.time == pytest.approx(f.time)


@pytest.mark.gl
def test_a_brightness_step_changes_the_image_and_not_the_detections(simulate):
    step = 'fault=[{kind="lighting",start=0.5,magnitude=0.4}]'
    _, steady, _ = simulate("quick", camera="rendered", duration=0.6)
    _, stepped, _ = simulate("quick", step, camera="rendered", duration=0.6)
    a, b = steady.frames[-1], stepped.frames[-1]
    assert b.image.mean() == pytest.approx(0.4 * a.image.mean(), rel=0.1)
    assert [d.label for d in a.detections] == [d.label for d in b.detections]


@pytest.mark.gl
def test_a_table_learnt_from_rendered_images_detects_as_the_declared_one(simulate, tmp_path):
    pairs = []
    for pan in (-0.9, -0.3, 0.3, 0.9):
        image, mask = labelled(0, pan, -0.3)
        labels = np.zeros(mask.shape[:2], np.uint8)
        for label, rgb in enumerate(mask_colors().values(), start=1):
            labels[(mask == rgb).all(axis=2)] = label
        pairs.append((image, labels))
    save_table(learn(pairs), tmp_path / "colors.npz")
    labels = []
    for setting in ([], [f"vision.color_table={tmp_path / 'colors.npz'}"]):
        still = (*setting, "navigation.gaze.mode=fixed")
        _, recorded, _ = simulate("course", *still, camera="rendered", seed=3, duration=0.6)
        labels.append([sorted(d.label for d in f.detections) for f in recorded.frames])
    declared, learnt = labels
    assert sum(map(len, declared)) > 20
    same = sum(a == b for a, b in zip(declared, learnt, strict=True))
    assert same >= 0.9 * len(declared)
