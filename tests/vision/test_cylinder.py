from dataclasses import replace
from math import asin, radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, Cylinder, Pose, at, pose, traced, true_polar
from vision.cylinder import Candidate, RimCue, interpenetrate, locate, polar_in_robot
from vision.outline import Outline
from vision.view import EXACT, View

TYPICAL_RADIUS = (0.085, 0.02)
NOISE = (0.01, 0.1, 3.5)  # roundness, correlation along an edge, deviation of a stray point


def outline_of(obstacle: Cylinder, gaze: Pose) -> Outline:
    _, _, (outline,) = traced([obstacle], gaze)
    return outline


def foot_of(outline: Outline) -> RimCue:
    return RimCue(outline.bottom, 0.0, near=True)


def head_of(outline: Outline) -> RimCue:
    return RimCue(outline.top, 0.30, near=False)


@settings(max_examples=30)
@given(
    distance=st.floats(0.6, 2.2),
    bearing=st.floats(-25.0, 25.0),
    radius=st.floats(0.05, 0.12),
    tilt=st.floats(-0.45, -0.25),
)
def test_foot_head_and_both_agree_within_their_uncertainty(distance, bearing, radius, tilt) -> None:
    obstacle, gaze = at(distance, bearing, "red", radius), pose(tilt=tilt)
    outline, view = outline_of(obstacle, gaze), View(CAMERA, gaze)
    foot, head = foot_of(outline), head_of(outline)
    sides = (outline.left, outline.right)
    result = locate(
        [
            Candidate(*sides, rims, 0.30, *TYPICAL_RADIUS)
            for rims in ((foot,), (head,), (foot, head))
        ],
        view,
        *NOISE,
    )
    for cylinder in result:
        sigma = np.sqrt(np.diag(cylinder.covariance))
        assert abs(cylinder.azimuth - radians(bearing)) < 4.0 * sigma[0]
        assert abs(cylinder.distance - distance) < 4.0 * sigma[1]
        assert abs(cylinder.radius - radius) < 4.0 * sigma[2]
        assert np.linalg.eigvalsh(cylinder.covariance).min() > 0.0
    assert result[2].covariance[1, 1] <= min(c.covariance[1, 1] for c in result[:2])


def test_both_sides_alone_give_the_distance_of_the_typical_radius() -> None:
    outline = outline_of(at(1.5, 0.0, "red", 0.085), pose(tilt=-0.3))
    view = View(CAMERA, pose(tilt=-0.3))
    (cylinder,) = locate(
        [Candidate(outline.left, outline.right, (), 0.30, *TYPICAL_RADIUS)], view, *NOISE
    )
    assert cylinder.distance == pytest.approx(1.5, rel=0.04)
    assert cylinder.covariance[1, 1] ** 0.5 == pytest.approx(1.5 * 0.02 / 0.085, rel=0.1)


def test_one_side_is_enough_to_find_the_axis() -> None:
    obstacle, gaze = at(1.2, 5.0, "green", 0.09), pose(tilt=-0.3)
    outline, view = outline_of(obstacle, gaze), View(CAMERA, gaze)
    middle = 0.5 * (outline.left.azimuth + outline.right.azimuth)
    hidden = replace(outline.left, azimuth=middle, trusted=False)
    rims = (foot_of(outline), head_of(outline))
    (cylinder,) = locate(
        [Candidate(hidden, outline.right, rims, 0.30, *TYPICAL_RADIUS)], view, *NOISE
    )
    assert cylinder.azimuth == pytest.approx(radians(5.0), abs=4 * cylinder.covariance[0, 0] ** 0.5)
    assert outline.right.azimuth == pytest.approx(radians(5.0) - asin(0.09 / 1.2), abs=0.004)


@pytest.mark.parametrize(
    ("sigma", "rates"),
    [
        ({"tilt_sigma": 0.02}, {}),
        ({"roll_sigma": 0.02}, {}),
        ({"yaw_sigma": 0.02}, {}),
        ({"height_sigma": 0.02}, {}),
        ({}, {"pan_rate": -2.0}),
        ({}, {"tilt_rate": 2.0}),
    ],
)
def test_every_error_of_the_pose_makes_the_place_less_certain(sigma, rates) -> None:
    gaze = pose(pan=radians(30.0), tilt=-0.3)
    outline = outline_of(at(1.5, 15.0, "red"), gaze)
    candidate = Candidate(
        outline.left, outline.right, (foot_of(outline), head_of(outline)), 0.30, *TYPICAL_RADIUS
    )
    (exact,) = locate([candidate], View(CAMERA, gaze), *NOISE)
    blurred = View(CAMERA, replace(gaze, **rates), replace(EXACT, **sigma), shutter=0.01)
    (vague,) = locate([candidate], blurred, *NOISE)
    slack = 0.05 * np.linalg.eigvalsh(exact.covariance).min()  # they are linearised apart
    assert np.linalg.eigvalsh(vague.covariance - exact.covariance).min() > -slack
    assert np.linalg.det(vague.covariance) > 1.05 * np.linalg.det(exact.covariance)


def test_place_in_the_robot_frame_follows_the_camera() -> None:
    obstacle = at(1.4, 35.0, "blue")
    gaze = pose(pan=radians(20.0), tilt=-0.3, position=(0.2, -0.3, 0.45))
    outline, view = outline_of(obstacle, gaze), View(CAMERA, gaze)
    rims = (foot_of(outline), head_of(outline))
    (cylinder,) = locate(
        [Candidate(outline.left, outline.right, rims, 0.30, *TYPICAL_RADIUS)], view, *NOISE
    )
    distance, bearing, covariance, by_radius = polar_in_robot(cylinder, view)
    expected = true_polar(obstacle)
    assert abs(distance - expected[0]) < 4.0 * covariance[0, 0] ** 0.5
    assert abs(bearing - expected[1]) < 4.0 * covariance[1, 1] ** 0.5
    # The Jacobian to polar coordinates about R, by finite differences.
    J = np.zeros((2, 2))
    for j, name in enumerate(("azimuth", "distance")):
        plus, minus = (
            polar_in_robot(replace(cylinder, **{name: getattr(cylinder, name) + e}), view)
            for e in (1e-6, -1e-6)
        )
        J[:, j] = (plus[0] - minus[0]) / 2e-6, (plus[1] - minus[1]) / 2e-6
    assert covariance == pytest.approx(J @ cylinder.covariance[:2, :2] @ J.T, rel=1e-5)
    P = cylinder.covariance
    assert by_radius == pytest.approx(J @ P[:2, 2] / P[2, 2], rel=1e-5)


def test_cylinders_interpenetrate_when_their_axes_are_too_close() -> None:
    view = View(CAMERA, pose(tilt=-0.3))
    outline = outline_of(at(1.0, 0.0, "red", 0.1), pose(tilt=-0.3))
    (here,) = locate(
        [Candidate(outline.left, outline.right, (foot_of(outline),), 0.30, 0.1, 0.01)], view, *NOISE
    )
    assert interpenetrate(here, here, 0.85)
    for step in (0.01, 0.1, 0.4):
        there = replace(here, distance=here.distance + step)
        for shared in (0.85, 0.3):
            near = step < shared * 2.0 * here.radius
            assert interpenetrate(here, there, shared) is near
            assert interpenetrate(there, here, shared) is near


@pytest.mark.parametrize("unit", [0.3, 3.15])
def test_a_scene_of_another_size_is_located_alike(unit: float) -> None:
    gaze, sigma = pose(tilt=-0.3), replace(EXACT, height_sigma=0.004)
    outline = outline_of(at(1.5, 5.0, "red"), gaze)
    cues = (foot_of(outline), head_of(outline))
    candidate = Candidate(outline.left, outline.right, cues, 0.30, *TYPICAL_RADIUS)
    (small,) = locate([candidate], View(CAMERA, gaze, sigma), *NOISE)
    (large,) = locate(
        [
            replace(
                candidate,
                rims=tuple(replace(cue, height=unit * cue.height) for cue in cues),
                height=unit * 0.30,
                radius=unit * TYPICAL_RADIUS[0],
                radius_sigma=unit * TYPICAL_RADIUS[1],
            )
        ],
        View(
            CAMERA,
            replace(gaze, position=unit * gaze.position),
            replace(EXACT, height_sigma=unit * 0.004),
        ),
        *NOISE,
        unit=unit,
    )
    scale = np.array([1.0, unit, unit])
    found = np.array([large.azimuth, large.distance, large.radius])
    expected = scale * (small.azimuth, small.distance, small.radius)
    assert found == pytest.approx(expected, rel=1e-6)
    assert large.covariance == pytest.approx(np.outer(scale, scale) * small.covariance, rel=1e-5)
