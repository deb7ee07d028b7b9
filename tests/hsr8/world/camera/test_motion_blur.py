from dataclasses import replace

import numpy as np
import pytest

from hsr8.world.camera.motion_blur import MotionBlur
from tests.vision.scene import at, paint, pose, true_polar
from vision.camera import PinholeCamera
from vision.detector import Detector
from vision.parameters import VisionParameters

CAMERA = PinholeCamera.from_vertical_fov(320, 240, np.radians(70.0))
SHUTTER = 0.01
MIDDLE = slice(110, 130)  # rows where a pan shifts straight sideways


def blur(image, *rotation):
    return MotionBlur(CAMERA, SHUTTER).blur(image, np.array(rotation))


def bars():
    """White to the left of the middle, black to the right."""
    image = np.zeros((240, 320, 3), np.uint8)
    image[:, :160] = 240
    return image


def noise():
    return np.random.default_rng(0).integers(0, 256, (240, 320, 3), np.uint8)


def test_a_camera_at_rest_leaves_its_images_sharp():
    assert np.array_equal(blur(noise(), 0.0, 0.0, 0.0), noise())


@pytest.mark.parametrize("rotation", [(0.0, 6.0, 0.0), (4.0, 0.0, 0.0), (1.0, -3.0, 2.0)])
def test_what_is_alike_everywhere_stays_so(rotation):
    grey = np.full((240, 320, 3), 93, np.uint8)
    assert np.array_equal(blur(grey, *rotation), grey)


@pytest.mark.parametrize("rotation", [(0.0, 6.0, 0.0), (4.0, 0.0, 0.0), (1.0, -3.0, 2.0)])
def test_turning_the_other_way_smears_alike(rotation):
    rotation = np.array(rotation)
    one, other = blur(noise(), *rotation), blur(noise(), *-rotation)
    assert np.abs(one.astype(int) - other.astype(int)).max() <= 1
    assert not np.array_equal(one, noise())


@pytest.mark.parametrize("rate", [2.0, -4.0, 6.0])
def test_an_edge_is_smeared_by_what_the_camera_turns_and_stays_where_it_is(rate):
    row = blur(bars(), 0.0, rate, 0.0)[MIDDLE, :, 0].mean(axis=0)
    expected = CAMERA.focal * abs(rate) * SHUTTER
    slope = -np.gradient(row)
    columns = np.arange(320)
    centre = (slope * columns).sum() / slope.sum()
    width = np.sqrt(12.0 * (slope * (columns - centre) ** 2).sum() / slope.sum())
    assert centre == pytest.approx(159.5, abs=0.2)
    assert width == pytest.approx(expected, abs=1.0)
    assert row[:140] == pytest.approx(240.0)
    assert row[180:] == pytest.approx(0.0)


def test_a_pan_leaves_level_edges_sharp_on_the_horizon():
    level = np.zeros((240, 320, 3), np.uint8)
    level[:120] = 240
    smeared = blur(level, 0.0, 6.0, 0.0)
    assert np.array_equal(smeared[:118, 160], level[:118, 160])
    assert np.array_equal(smeared[122:, 160], level[122:, 160])


@pytest.mark.parametrize("rate", [3.0, 6.0])
def test_vision_is_as_far_off_in_smeared_images_as_it_says(rate):
    rng = np.random.default_rng(4)
    detector, known, unknown = Detector(CAMERA, VisionParameters(), (), SHUTTER), [], []
    for _ in range(24):
        cylinder = at(
            rng.uniform(0.7, 2.5), rng.uniform(-20.0, 20.0), "red", rng.uniform(0.06, 0.11)
        )
        gaze = pose(tilt=-0.35)
        image = blur(paint([cylinder], gaze), *(gaze.rotation.T @ (0.0, 0.0, rate)))
        for errors, measured in ((known, rate), (unknown, 0.0)):
            (detection,) = detector.detect(image, replace(gaze, pan_rate=measured))
            error = np.array([detection.distance, detection.bearing]) - true_polar(cylinder)
            errors.append(error @ np.linalg.solve(detection.covariance, error) / 2.0)
    assert 0.1 < np.mean(known) < 1.5 < np.mean(unknown)


@pytest.mark.parametrize(("ratio", "detected"), [(0.8, True), (1.2, True), (0.3, False)])
def test_an_obstacle_is_found_if_it_looks_about_as_wide_as_the_smear(ratio, detected):
    """And whatever makes it so: its size, its distance, the head's speed or the exposure."""
    rng = np.random.default_rng(6)
    for _ in range(6):
        distance, rate = rng.uniform(0.7, 1.4), rng.uniform(4.0, 6.0)
        radius = rng.uniform(0.06, 0.11)
        shutter = 2.0 * radius / distance / ratio / rate
        cylinder, gaze = at(distance, rng.uniform(-15.0, 15.0), "red", radius), pose(tilt=-0.35)
        rotation = gaze.rotation.T @ (0.0, 0.0, rate)
        image = MotionBlur(CAMERA, shutter).blur(paint([cylinder], gaze), rotation)
        detector = Detector(CAMERA, VisionParameters(), (), shutter)
        detections = detector.detect(image, replace(gaze, pan_rate=rate))
        assert (len(detections) == 1) is detected
