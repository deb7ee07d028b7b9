import pytest

from tests.vision.scene import HEIGHT, Cylinder, at, beacon, pose, traced
from vision.beacon import Post, find_posts
from vision.blob import Blob
from vision.color import COLOR_CLASSES
from vision.parameters import VisionParameters

NAMES = ("", *COLOR_CLASSES)
GAZE = pose(tilt=-0.1)


def posts(obstacles: list[Cylinder]) -> tuple[list[Blob], list[Post]]:
    blobs, _, outlines = traced(obstacles, GAZE, min_area=5)
    indices = [k for k, b in enumerate(blobs) if COLOR_CLASSES[NAMES[b.label]].kind == "beacon"]
    return blobs, find_posts(blobs, outlines, indices, HEIGHT, VisionParameters())


@pytest.mark.parametrize("x", [1.2, 2.5, 4.5])
def test_the_upper_color_comes_first_and_three_rims_are_seen(x: float) -> None:
    blobs, (post,) = posts(beacon(x, 0.0, "cyan", "magenta"))
    assert NAMES[blobs[post.upper].label] == "cyan"
    assert NAMES[blobs[post.lower].label] == "magenta"
    assert [cue.height for cue in post.candidate.rims] == pytest.approx([0.30, 0.0, 0.60])
    assert post.candidate.left.trusted
    assert post.candidate.right.trusted


def test_a_hidden_foot_leaves_seam_and_head() -> None:
    _, (post,) = posts([*beacon(3.0, 0.0, "cyan", "magenta"), at(1.5, 0.0, "red", 0.1)])
    assert [cue.height for cue in post.candidate.rims] == pytest.approx([0.30, 0.60])


def test_colors_side_by_side_are_no_post() -> None:
    halves = [Cylinder(2.0, 0.05, "cyan", 0.05), Cylinder(2.0, -0.05, "magenta", 0.05)]
    assert posts(halves)[1] == []


def test_a_narrow_color_on_a_wide_one_is_no_post() -> None:
    stack = [Cylinder(2.0, 0.0, "cyan", 0.1), Cylinder(2.0, 0.0, "yellow", 0.05, 0.30, 0.60)]
    assert posts(stack)[1] == []
