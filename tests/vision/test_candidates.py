import numpy as np
import pytest

from tests.vision.scene import HEIGHT, Cylinder, at, beacon, pose, traced
from vision.candidates import candidates_of
from vision.color import COLOR_CLASSES
from vision.detector import parameter_record
from vision.parameters import VisionParameters
from vision.sizes import Sizes
from vision.tables import FAR, NEAR, Candidate

NAMES = ("", *COLOR_CLASSES)
BEACON = np.array([False, *(c.kind == "beacon" for c in COLOR_CLASSES.values())])
GAZE = pose(tilt=-0.1)


def candidates(obstacles: list[Cylinder], gaze=GAZE):
    """Blobs and candidates of an image."""
    tables = traced(obstacles, gaze, min_area=5)
    p = parameter_record(VisionParameters())[0]
    rows = candidates_of(tables.blobs, tables.points, BEACON, HEIGHT, p)
    return tables.blobs, rows.view(Candidate)


def rims(candidate) -> list[tuple[float, float]]:
    """Height and half of the circle of each rim."""
    return [(rim.height, rim.half) for rim in candidate.rims[: candidate.rim_count]]


@pytest.mark.parametrize("x", [1.2, 2.5, 4.5])
def test_the_upper_color_comes_first_and_three_rims_are_seen(x: float) -> None:
    blobs, (post,) = candidates(beacon(x, 0.0, "cyan", "magenta"))
    assert NAMES[blobs[post.upper].label] == "cyan"
    assert NAMES[blobs[post.lower].label] == "magenta"
    assert rims(post) == [(0.0, NEAR), (0.30, NEAR), (0.60, NEAR)]
    assert post.sides[0].trusted
    assert post.sides[1].trusted
    assert post.prior == pytest.approx([0.05, 0.0005])


def test_a_hidden_foot_leaves_seam_and_head() -> None:
    blobs, (front, post) = candidates([*beacon(3.0, 0.0, "cyan", "magenta"), at(1.5, 0.0, "red")])
    assert NAMES[blobs[front.upper].label] == "red"
    assert rims(post) == [(0.30, NEAR), (0.60, NEAR)]
    assert post.occluded


def test_colors_side_by_side_are_no_post() -> None:
    halves = [Cylinder(2.0, 0.05, "cyan", 0.05), Cylinder(2.0, -0.05, "magenta", 0.05)]
    assert not len(candidates(halves)[1])


def test_an_obstacle_has_foot_and_head_and_the_typical_radius() -> None:
    _, (candidate,) = candidates([at(1.2, 0.0, "blue", 0.09)], pose(tilt=-0.3))
    assert rims(candidate) == [(0.0, NEAR), (0.30, FAR)]
    assert candidate.upper == candidate.lower == 0
    assert tuple(candidate.prior) == Sizes().radius_prior
    assert not candidate.occluded


def test_points_of_a_foot_next_to_a_nearer_obstacle_are_not_used() -> None:
    scene = [at(0.9, 4.0, "red", 0.09), at(1.5, 0.0, "green", 0.10)]
    blobs, rows = candidates(scene, pose(tilt=-0.3))
    behind = next(row for row in rows if NAMES[blobs[row.lower].label] == "green")
    assert behind.occluded
    for rim in behind.rims[: behind.rim_count]:
        if rim.height == 0.0:
            assert rim.outer == 0
