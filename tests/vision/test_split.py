from math import asin

import numpy as np
import pytest

from tests.vision.scene import CAMERA, Cylinder, at, paint, pose, traced, true_polar
from vision.detector import Detector, parameter_record
from vision.parameters import VisionParameters
from vision.split import split
from vision.tables import FAR, NEAR, Candidate

GAZE = pose(tilt=-0.4)


def parts_of(obstacles: list[Cylinder]):
    """Parts of the only blob of an image."""
    image, p = traced(obstacles, GAZE), parameter_record(VisionParameters())[0]
    assert len(image.blobs) == 1
    tables = image.blobs, image.runs, image.padded
    parts, _, counts = split(
        np.zeros(1, Candidate), np.zeros(1, np.int64), *tables, image.view[0], p
    )
    assert counts.tolist() == [len(parts)]
    return parts.view(Candidate)


@pytest.mark.parametrize("offset", [-4.0, -2.0, 0.0, 2.0, 4.0])
@pytest.mark.parametrize(("distance", "radius"), [(0.9, 0.08), (0.55, 0.12)])
def test_a_foot_has_the_sides_of_the_nearer_obstacle_a_head_those_of_the_farther(
    distance, radius, offset
) -> None:
    obstacles = at(distance, 0.0, "red", radius), at(1.5, offset, "red", 0.07)
    whole = [part for part in parts_of([*obstacles]) if part.sides["trusted"].all()]
    assert [part.rims[0].half for part in whole] == [NEAR, FAR]
    assert [part.occluded for part in whole] == [False, True]
    for part, obstacle in zip(whole, obstacles, strict=True):
        far, bearing = true_polar(obstacle)
        reach = asin(obstacle.radius / far)
        sides = bearing + reach, bearing - reach
        assert part.sides["azimuth"] == pytest.approx(sides, abs=0.012)  # two columns


def test_a_blob_without_steps_has_no_parts() -> None:
    assert not len(parts_of([at(1.0, 0.0, "red")]))


def test_of_two_of_a_color_the_hidden_one_is_placed_as_well_as_it_says() -> None:
    """In random relative positions."""
    rng = np.random.default_rng(0)
    detector = Detector(CAMERA, VisionParameters())
    errors = []
    for _ in range(60):
        near = rng.uniform(1.2, 2.6)
        far = rng.uniform(near + 0.4, 3.6)
        radii = rng.uniform(0.05, 0.12, 2)
        apart = np.degrees(rng.uniform(-1.1, 1.1) * (radii[0] / near + radii[1] / far))
        position = rng.uniform(-20, 20)
        obstacles = [
            at(near, position, "red", radii[0]),
            at(far, position + apart, "red", radii[1]),
        ]
        view = pose(pan=rng.uniform(-0.3, 0.3), tilt=rng.uniform(-0.45, -0.1))
        distance, bearing = far, np.radians(position + apart)
        for d in detector.detect(paint(obstacles, view), view):
            if abs(d.distance - far) < abs(d.distance - near):
                error = np.array([d.distance - distance, d.bearing - bearing])
                errors.append(error / np.sqrt(np.diag(d.covariance)))
    assert len(errors) > 50
    assert np.mean(np.square(errors), axis=0).max() < 1.0
    assert np.abs(errors).max() < 3.5


def test_a_blob_wider_than_any_obstacle_has_an_inflated_covariance() -> None:
    """Two side by side at one distance leave no step in their outline."""
    view = pose(tilt=-0.3)
    pair = [at(1.6, -2.7, "red", 0.08), at(1.6, 2.7, "red", 0.08)]
    (blob,) = Detector(CAMERA, VisionParameters()).detect(paint(pair, view), view)
    assert blob.radius > 0.13
    sigma = np.sqrt(blob.covariance[1, 1])
    assert abs(blob.bearing - np.radians(2.7)) < 1.5 * sigma
    assert abs(blob.bearing + np.radians(2.7)) < 1.5 * sigma
