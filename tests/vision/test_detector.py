from dataclasses import replace
from math import degrees, hypot, radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, Cylinder, at, beacon, paint, pose, true_polar, uncertain
from vision.camera import PinholeCamera
from vision.color import COLOR_CLASSES
from vision.detection import Detection
from vision.detector import Detector
from vision.errors import VisionError
from vision.parameters import PoseParameters, VisionParameters
from vision.sizes import Sizes

DETECTOR = Detector(CAMERA, VisionParameters())
UNSURE = Detector(CAMERA, VisionParameters(), sizes=Sizes(obstacle_height=(0.09, 0.27)))


def see(obstacles, view=None, brightness=1.0) -> tuple[Detection, ...]:
    view = view or pose()
    return DETECTOR.detect(paint(obstacles, view, brightness), view)


def assert_located(detection: Detection, obstacle: Cylinder, sigmas: float = 4.0) -> None:
    """The detection is right within its own standard deviations."""
    distance, bearing = true_polar(obstacle)
    error = np.array([detection.distance - distance, detection.bearing - bearing])
    assert error @ np.linalg.solve(detection.covariance, error) < sigmas**2
    assert abs(detection.radius - obstacle.radius) < sigmas * detection.radius_sigma


@settings(max_examples=40)
@given(
    distance=st.floats(0.45, 2.5),
    bearing=st.floats(-30.0, 30.0),
    radius=st.floats(0.05, 0.12),
    tilt=st.floats(-0.55, -0.1),
    roll=st.floats(-0.08, 0.08),
    pan=st.floats(-1.4, 1.4),
)
def test_a_lone_obstacle_is_located_wherever_the_head_looks(
    distance, bearing, radius, tilt, roll, pan
) -> None:
    obstacle = at(distance, degrees(pan) + bearing, "green", radius)
    view = pose(pan, tilt, roll, position=(0.03, 0.01, 0.47))
    result = [d for d in see([obstacle], view) if not d.cut]
    if not result:  # it may leave the image at the edges of what is drawn
        assert all(d.cut for d in see([obstacle], view))
        return
    (detection,) = result
    assert detection.label == "green"
    assert not detection.occluded
    # Six: hypothesis looks for edges that run along the pixels, which err everywhere alike.
    assert_located(detection, obstacle, sigmas=6.0)
    assert abs(detection.distance - distance) < 0.02 + 0.03 * distance
    assert abs(detection.bearing - np.arctan2(obstacle.y, obstacle.x)) < radians(0.6)


@pytest.mark.parametrize("color", [n for n, c in COLOR_CLASSES.items() if c.kind == "obstacle"])
@pytest.mark.parametrize("brightness", [0.4, 1.0, 1.6])
def test_light_changes_neither_color_nor_place(color: str, brightness: float) -> None:
    (detection,) = see([at(1.2, 10.0, color)], brightness=brightness)
    (reference,) = see([at(1.2, 10.0, color)])
    assert detection.label == color
    assert detection.distance == pytest.approx(reference.distance, abs=1e-9)
    assert detection.bearing == pytest.approx(reference.bearing, abs=1e-9)


@settings(max_examples=25)
@given(
    distances=st.lists(st.floats(0.5, 2.3), min_size=3, max_size=3),
    tilt=st.floats(-0.5, -0.15),
)
def test_a_mirrored_scene_gives_mirrored_detections(distances, tilt) -> None:
    bearings = (-25.0, 2.0, 24.0)
    colors = ("red", "green", "blue")
    scene = [at(d, b, c) for d, b, c in zip(distances, bearings, colors, strict=True)]
    mirror = [Cylinder(c.x, -c.y, c.color, c.radius) for c in scene]
    observed, seen_mirrored = see(scene, pose(tilt=tilt)), see(mirror, pose(tilt=tilt))
    assert len(observed) == len(seen_mirrored) > 0
    for a, b in zip(observed, seen_mirrored, strict=True):
        assert (a.label, a.cut, a.occluded) == (b.label, b.cut, b.occluded)
        assert a.distance == pytest.approx(b.distance, abs=2e-3)
        assert a.bearing == pytest.approx(-b.bearing, abs=2e-3)


def test_detections_are_sorted_and_independent_of_earlier_images() -> None:
    scene = [at(2.0, -20.0, "red"), at(0.8, 0.0, "green"), at(1.4, 18.0, "violet")]
    first = see(scene)
    see([at(1.0, 5.0, "blue")])
    second = see(scene)
    assert [d.label for d in first] == ["green", "violet", "red"]
    assert [(d.distance, d.bearing) for d in first] == [(d.distance, d.bearing) for d in second]


def test_an_occluded_obstacle_is_still_located_and_flagged() -> None:
    front, back = at(0.9, 3.0, "red"), at(1.5, 0.0, "green")
    result = {d.label: d for d in see([front, back], pose(tilt=-0.3))}
    assert not result["red"].occluded
    assert result["green"].occluded
    assert_located(result["red"], front)
    assert_located(result["green"], back)


def test_an_obstacle_cut_by_the_border_is_flagged_and_less_certain() -> None:
    obstacle = at(1.0, 0.0, "blue")
    (whole,) = see([obstacle], pose(tilt=-0.3))
    (cut,) = see([obstacle], pose(pan=radians(-45.0), tilt=-0.3))
    assert not whole.cut
    assert cut.cut
    assert cut.covariance[1, 1] > 4.0 * whole.covariance[1, 1]
    assert_located(cut, obstacle)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("distance", [0.4, 0.45, 0.5])
def test_an_obstacle_of_which_one_side_shows_is_located_by_how_much_of_it(distance, side) -> None:
    """The head points down and to the side: close obstacles are cut by the border."""
    obstacle = at(distance, side * 144.0, "green", 0.08)
    view = pose(side * 1.5708, radians(-20.0), position=(0.0, 0.0, 0.45))
    (detection,) = see([obstacle], view)
    assert detection.cut
    assert_located(detection, obstacle)
    assert abs(detection.distance - distance) < 0.1 * distance


def test_an_obstacle_whose_foot_is_out_of_the_image_is_located_by_its_head() -> None:
    obstacle = at(0.45, 0.0, "violet", 0.1)
    (detection,) = see([obstacle], pose(tilt=0.0))
    assert detection.cut
    assert_located(detection, obstacle)


@pytest.mark.parametrize(
    ("near", "far"),
    [
        (at(0.8, 2.0, "green", 0.07), at(1.3, -3.0, "green", 0.07)),
        (at(1.0, 0.0, "green", 0.11), at(1.7, 0.0, "green", 0.06)),
        (at(1.5, 3.0, "green", 0.06), at(2.2, 0.5, "green", 0.10)),
    ],
    ids=["beside", "behind", "far"],
)
def test_overlapping_obstacles_of_one_color_are_separated(near: Cylinder, far: Cylinder) -> None:
    first, second = see([near, far], pose(tilt=-0.3))
    assert_located(first, near)
    assert_located(second, far)
    assert second.occluded
    assert first.box == second.box


def test_beacons_are_named_top_over_bottom_and_located() -> None:
    for top, bottom in (("yellow", "cyan"), ("cyan", "yellow"), ("magenta", "cyan")):
        for x, y in ((1.5, 0.3), (3.0, -0.8), (4.5, 0.6)):
            (detection,) = see(beacon(x, y, top, bottom), pose(tilt=-0.1))
            assert detection.kind == "beacon"
            assert detection.label == f"{top}/{bottom}"
            assert detection.radius == pytest.approx(0.05, abs=0.002)
            assert_located(detection, Cylinder(x, y, top, 0.05))
            assert abs(detection.distance - hypot(x, y)) < 0.03 * hypot(x, y)


def test_a_beacon_behind_an_obstacle_keeps_its_name_or_is_not_seen() -> None:
    for distance in np.linspace(0.5, 2.9, 13).tolist():
        scene = [*beacon(3.0, 0.0, "yellow", "magenta"), at(distance, 0.5, "red", 0.12)]
        names = [d.label for d in see(scene, pose(tilt=-0.1)) if d.kind == "beacon"]
        assert names == ["yellow/magenta"] or (names == [] and distance > 2.6)


def test_beacons_close_to_each_other_in_the_image_do_not_swap_colors() -> None:
    names = {"yellow/cyan", "magenta/yellow"}
    for y in np.linspace(0.0, 0.4, 9).tolist():
        scene = beacon(2.5, 0.0, "yellow", "cyan") + beacon(3.2, y, "magenta", "yellow")
        observed = {d.label for d in see(scene, pose(tilt=-0.1))}
        assert observed <= names
    assert observed == names


def test_an_error_of_the_tilt_is_within_its_uncertainty() -> None:
    obstacle = at(2.0, 8.0, "red")
    image = paint([obstacle], pose(tilt=-0.25))
    for error in (-1.0, 1.0):
        wrong = pose(tilt=-0.25 + radians(error))
        (detection,) = Detector(CAMERA, uncertain(radians(0.7))).detect(image, wrong)
        assert_located(detection, obstacle, sigmas=3.0)


def test_a_detection_is_as_certain_as_required() -> None:
    view, limit, counts = pose(tilt=-0.25), 0.003, set()
    image = paint([at(0.9, 8.0, "red")], view)
    for sigma in (0.0, 0.02):
        parameters = replace(uncertain(sigma), max_relative_sigma=limit)
        detections = Detector(CAMERA, parameters).detect(image, view)
        assert all(d.covariance[0, 0] <= (limit * d.distance) ** 2 for d in detections)
        counts.add(len(detections))
    assert counts == {0, 1}


@pytest.mark.parametrize("unknown", [{"tilt_sigma": 1e7}, {"height_sigma": 1e8}])
def test_an_infinite_uncertainty_gives_no_detection(unknown) -> None:
    view = pose(tilt=-0.1)
    image = paint([at(1.0, 5.0, "green"), at(2.0, -20.0, "red"), at(1.6, 20.0, "blue")], view)
    assert len(DETECTOR.detect(image, view)) == 3
    parameters = VisionParameters(pose=PoseParameters(**unknown))
    assert Detector(CAMERA, parameters).detect(image, view) == ()


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((120, 160, 3), np.uint8),
        np.zeros((240, 320), np.uint8),
        np.zeros((240, 320, 3), np.float32),
    ],
    ids=["size", "grey", "dtype"],
)
def test_other_images_are_refused(image: np.ndarray) -> None:
    with pytest.raises(VisionError, match="image"):
        DETECTOR.detect(image, pose())


def test_a_radius_that_is_known_is_not_estimated() -> None:
    known = Detector(CAMERA, VisionParameters(), sizes=Sizes(obstacle_radius=(0.09, 0.09)))
    image = paint([at(1.2, 0.0, "blue", 0.09)], pose(tilt=-0.3))
    (detection,) = known.detect(image, pose(tilt=-0.3))
    assert detection.radius == pytest.approx(0.09, abs=1e-3)
    assert detection.radius_sigma <= VisionParameters().known_radius_sigma


PAINTS = np.array([(0.0, 0.0, 0.0), *(c.rgb for c in COLOR_CLASSES.values())])
LEVEL_OR_NOT = [pose(), pose(0.5, -0.6), pose(0.0, -np.pi / 2), pose(0.1, -0.3, 1.5), pose(0, 1.2)]


@settings(max_examples=50)
@given(
    size=st.sampled_from([(1, 1), (1, 7), (5, 3), (32, 24), (64, 48)]),
    view=st.sampled_from(LEVEL_OR_NOT),
    boxes=st.lists(st.tuples(*[st.integers(-4, 68)] * 4, st.integers(0, 7)), max_size=30),
    smallest=st.sampled_from([1, 20]),
)
def test_every_detection_in_an_arbitrary_image_is_valid(size, view, boxes, smallest) -> None:
    """Blobs at every border, many of them, of one pixel; a rim that looks level."""
    width, height = size
    labels = np.zeros((height, width), int)
    for left, top, right, bottom, label in boxes:
        labels[max(top, 0) : max(bottom, 0), max(left, 0) : max(right, 0)] = label
    camera = PinholeCamera.from_vertical_fov(width, height, 1.2)
    parameters = VisionParameters(min_area=smallest, min_beacon_area=smallest)
    image = np.round(255 * PAINTS[labels]).astype(np.uint8)
    for result in Detector(camera, parameters).detect(image, view):
        assert np.isfinite([result.distance, result.bearing, result.radius]).all()
        assert np.linalg.eigvalsh(result.covariance)[0] > 0.0
        assert 0 <= result.box[0] < result.box[2] <= width
        assert 0 <= result.box[1] < result.box[3] <= height


@settings(max_examples=40)
@given(
    distance=st.floats(0.4, 2.5),
    bearing=st.floats(-30.0, 30.0),
    radius=st.floats(0.055, 0.115),
    height=st.floats(0.095, 0.265),
    tilt=st.floats(-0.55, -0.1),
)
def test_an_obstacle_of_unknown_height_is_located_by_its_foot(
    distance, bearing, radius, height, tilt
) -> None:
    """Without its foot, the prior of the height makes the distance uncertain, not wrong."""
    obstacle = replace(at(distance, bearing, "green", radius), high=height)
    view = pose(0.0, tilt)
    for detection in UNSURE.detect(paint([obstacle], view), view):
        assert_located(detection, obstacle, sigmas=6.0)
        if not detection.cut:
            assert abs(detection.distance - distance) < 0.02 + 0.03 * distance
