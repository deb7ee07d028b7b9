from dataclasses import astuple
from math import asin, degrees, hypot

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, Cylinder, Pose, at, paint, pose, traced
from vision.blob import find_blobs
from vision.color import COLOR_CLASSES, OUTSIDE, ColorTable
from vision.cylinder_fit import independent
from vision.outline import Outline, envelopes, silhouettes, trace
from vision.view import View, angles

NAMES = ("", *COLOR_CLASSES)
PIXEL = 1.0 / CAMERA.focal


def outlines(obstacles: list[Cylinder], gaze: Pose) -> dict[str, Outline]:
    return outlines_in(paint(obstacles, gaze), gaze)


def outlines_in(image: np.ndarray, gaze: Pose) -> dict[str, Outline]:
    labels = ColorTable().classify(image)
    blobs = find_blobs(labels, (20,) * 7)
    padded = np.pad(labels, 1, constant_values=OUTSIDE)
    traced = trace(blobs, padded, View(CAMERA, gaze), 0.35)
    return {NAMES[blob.label]: outline for blob, outline in zip(blobs, traced, strict=True)}


@pytest.mark.parametrize("roll", [-0.1, 0.0, 0.1])
@pytest.mark.parametrize("tilt", [-0.9, -0.5, -0.2])
@pytest.mark.parametrize("bearing", [-28.0, 0.0, 28.0])
def test_sides_are_the_tangents_of_the_cylinder(roll: float, tilt: float, bearing: float) -> None:
    distance = 0.7 if tilt < -0.6 else 1.3
    obstacle = at(distance, bearing, "green", 0.08)
    outline = outlines([obstacle], pose(tilt=tilt, roll=roll)).get("green")
    assert outline is not None
    azimuth = np.arctan2(obstacle.y, obstacle.x) - View(CAMERA, pose(tilt=tilt, roll=roll)).heading
    half = asin(0.08 / distance)
    for side, expected in ((outline.left, azimuth + half), (outline.right, azimuth - half)):
        if side.trusted:
            assert side.azimuth == pytest.approx(expected, abs=1.2 * PIXEL)
    assert outline.left.azimuth > outline.right.azimuth


def test_rims_lie_on_the_floor_and_at_the_height_of_the_head() -> None:
    outline = outlines([at(1.2, 0.0, "blue", 0.09)], pose(tilt=-0.3))["blue"]
    middle = len(outline.bottom.slope) // 2
    assert -0.47 / outline.bottom.slope[middle] == pytest.approx(1.2 - 0.09, rel=0.02)
    assert -0.17 / np.median(outline.top.slope) == pytest.approx(1.2 + 0.09, rel=0.06)
    assert outline.bottom.occlusion_fraction == 0.0


def test_edges_next_to_another_color_are_not_taken_for_the_own() -> None:
    front, back = at(0.9, 4.0, "red", 0.09), at(1.6, 0.0, "green", 0.10)
    observed = outlines([front, back], pose(tilt=-0.3))
    assert observed["green"].left.occluded
    assert not observed["red"].right.occluded
    assert (
        observed["green"].bottom.occlusion_fraction == 0.0
        or observed["green"].bottom.occlusion_fraction < 1.0
    )
    half = asin(0.10 / hypot(back.x, back.y))
    for side, expected in ((observed["green"].left, half), (observed["green"].right, -half)):
        if side.trusted:
            assert side.azimuth == pytest.approx(expected, abs=1.5 * PIXEL)


def test_an_occluded_foot_is_not_visible() -> None:
    front, back = at(0.8, 0.0, "red", 0.12), at(1.6, 0.0, "violet", 0.05)
    observed = outlines([front, back], pose(tilt=-0.3))
    assert observed["violet"].bottom.occlusion_fraction == 1.0
    assert observed["violet"].bottom.free().slope.size == 0
    label = NAMES.index("red")
    assert (
        observed["violet"].bottom.against(label).slope.size == observed["violet"].bottom.slope.size
    )


def test_a_side_beyond_the_border_is_not_trusted() -> None:
    edge = degrees(0.5 * CAMERA.horizontal_fov)
    observed = outlines([at(1.0, edge + 2.0, "green", 0.1)], pose(tilt=-0.3))["green"]
    assert not observed.left.trusted
    assert observed.right.trusted


@given(count=st.integers(1, 80), crossed=st.floats(0.0, 20.0))
def test_points_with_errors_of_their_own_are_one_at_least_and_all_at_most(count, crossed) -> None:
    own = independent(float(count), crossed)
    straight, slanting = independent(float(count), 0.0), independent(float(count), 1e3)
    assert 1.0 <= own <= count * (1 + 1e-12)
    assert straight == pytest.approx(1.0)
    assert slanting == pytest.approx(count)


def test_noise_at_the_border_of_the_image_makes_no_edge() -> None:
    """One unrecognised pixel in the last column is not the side of what the border cuts."""
    obstacle, view = at(0.8, -43.0, "green", 0.10), pose(tilt=-0.4)
    image = paint([obstacle], view)
    clean = outlines_in(image, view)["green"]
    assert not clean.right.trusted
    rows = np.flatnonzero(ColorTable().classify(image)[:, -1])
    image[rows[len(rows) // 2], -1] = 128
    spoiled = outlines_in(image, view)["green"]
    assert not spoiled.right.trusted
    assert astuple(spoiled.left) == astuple(clean.left)


OBSTACLES = [
    at(0.9, 4.0, "red", 0.09),
    at(1.6, 0.0, "green", 0.10),
    at(1.1, -30.0, "blue", 0.12),
    at(2.4, 18.0, "red", 0.05),
]


def observed(pan, roll):
    """Blobs, padded labels and packed view of the obstacles."""
    gaze = pose(pan=pan, tilt=-0.3, roll=roll)
    blobs, padded, _ = traced(OBSTACLES, gaze)
    return blobs, padded, View(CAMERA, gaze).packed


def test_envelopes_bound_the_directions_of_all_pixels():
    """Lowest and highest slope of a blob near each azimuth, from the middles of its pixels."""
    blobs, padded, view = observed(0.1, 0.05)
    for blob in blobs:
        box = np.array(blob.box, np.int32)
        start, width, size, (low, high), _ = envelopes(box, blob.extents, blob.runs, padded, view)
        middles = [
            (column + 0.5, row + 0.5)
            for row, first, last, _ in blob.runs.tolist()
            for column in range(first, last)
        ]
        for u, v in middles:
            azimuth, slope = angles(view, u, v)
            column = int((azimuth - start) / width)
            near = slice(max(column - 1, 0), column + 2)
            assert low[near].min() - size < slope < high[near].max() + size


def test_no_pixel_of_a_rim_is_without_size():
    """Seen steeply, the ends of rows in the middle column run along one slope."""
    labels = np.zeros((CAMERA.height, CAMERA.width), np.uint8)
    labels[20:100, 40 : CAMERA.width // 2] = 1
    (blob,) = find_blobs(labels, (20,))
    box, padded = np.array([blob.box], np.int32), np.pad(labels, 1, constant_values=OUTSIDE)
    _, _, sizes, *_ = silhouettes(box, blob.extents, padded, View(CAMERA, pose(tilt=1.2)).packed)
    assert 0.0 < sizes.min() < 1e-3
