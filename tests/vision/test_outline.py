from math import asin, degrees, hypot

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, at, paint, pose, traced, traced_in
from vision.blob import find_blobs
from vision.color import COLOR_CLASSES, ColorTable
from vision.outline import independent, trace
from vision.tables import OUTSIDE, count_next_to
from vision.view import view_of

NAMES = ("", *COLOR_CLASSES)
PIXEL = 1.0 / CAMERA.focal


@pytest.mark.parametrize("roll", [-0.1, 0.0, 0.1])
@pytest.mark.parametrize("tilt", [-0.9, -0.5, -0.2])
@pytest.mark.parametrize("bearing", [-28.0, 0.0, 28.0])
def test_sides_are_the_tangents_of_the_cylinder(roll: float, tilt: float, bearing: float) -> None:
    distance = 0.7 if tilt < -0.6 else 1.3
    obstacle = at(distance, bearing, "green", 0.08)
    image = traced([obstacle], pose(tilt=tilt, roll=roll))
    left, right = image.named("green").sides
    azimuth = np.arctan2(obstacle.y, obstacle.x) - image.view[0].heading
    half = asin(0.08 / distance)
    for side, expected in ((left, azimuth + half), (right, azimuth - half)):
        if side.trusted:
            assert side.azimuth == pytest.approx(expected, abs=1.2 * PIXEL)
    assert left.azimuth > right.azimuth


def test_rims_lie_on_the_floor_and_at_the_height_of_the_head() -> None:
    image = traced([at(1.2, 0.0, "blue", 0.09)], pose(tilt=-0.3))
    (_, bottom, outer), (_, top, _) = (image.rim(rim) for rim in image.blobs[0].rims)
    assert -0.47 / bottom[len(bottom) // 2] == pytest.approx(1.2 - 0.09, rel=0.02)
    assert -0.17 / np.median(top) == pytest.approx(1.2 + 0.09, rel=0.06)
    assert not outer.any()


def test_edges_next_to_another_color_are_not_taken_for_the_own() -> None:
    front, back = at(0.9, 4.0, "red", 0.09), at(1.6, 0.0, "green", 0.10)
    observed = traced([front, back], pose(tilt=-0.3))
    (left, right), (_, red_right) = observed.named("green").sides, observed.named("red").sides
    assert left.occluded
    assert not red_right.occluded
    bottom = observed.named("green").rims[0]
    assert count_next_to(bottom, 0, observed.points) > 0
    half = asin(0.10 / hypot(back.x, back.y))
    for side, expected in ((left, half), (right, -half)):
        if side.trusted:
            assert side.azimuth == pytest.approx(expected, abs=1.5 * PIXEL)


def test_an_occluded_foot_is_not_visible() -> None:
    front, back = at(0.8, 0.0, "red", 0.12), at(1.6, 0.0, "violet", 0.05)
    observed = traced([front, back], pose(tilt=-0.3))
    bottom = observed.named("violet").rims[0]
    assert count_next_to(bottom, 0, observed.points) == 0
    assert count_next_to(bottom, NAMES.index("red"), observed.points) == bottom.last - bottom.first


def test_a_side_beyond_the_border_is_not_trusted() -> None:
    edge = degrees(0.5 * CAMERA.horizontal_fov)
    left, right = traced([at(1.0, edge + 2.0, "green", 0.1)], pose(tilt=-0.3)).blobs[0].sides
    assert not left.trusted
    assert right.trusted


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
    clean = traced_in(image, view).named("green").sides
    assert not clean[1].trusted
    rows = np.flatnonzero(ColorTable().classify(image)[:, -1])
    image[rows[len(rows) // 2], -1] = 128
    spoiled = traced_in(image, view).named("green").sides
    assert not spoiled[1].trusted
    assert spoiled[0] == clean[0]


def test_no_pixel_of_a_rim_is_without_size():
    """Seen steeply, the ends of rows in the middle column run along one slope."""
    labels = np.zeros((CAMERA.height, CAMERA.width), np.uint8)
    labels[20:100, 40 : CAMERA.width // 2] = 1
    blobs, _, extents = find_blobs(labels, np.array([20], np.int32))
    padded = np.pad(labels, 1, constant_values=OUTSIDE)
    trace(blobs, extents, padded, view_of(CAMERA, pose(tilt=1.2))[0], 1.0)
    sizes = blobs["rims"]["sigma"]
    assert 0.0 < sizes.min() < 1e-3
