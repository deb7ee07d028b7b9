from dataclasses import replace
from math import radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, Cylinder, Pose, at, candidate_of, pose, traced, true_polar
from vision.cylinder import interpenetrate, polar_in_robot
from vision.cylinder_fit import fit
from vision.detector import parameter_record
from vision.parameters import VisionParameters
from vision.tables import FAR, NEAR
from vision.view import EXACT, view_of

TYPICAL_RADIUS = (0.085, 0.02)
# Half of the step is a deviation of 3.5 sigma.
NOISE = VisionParameters(
    edge_sigma=0.35, roundness_sigma=0.01, edge_correlation=0.1, outline_step=2.45
)


class Image:
    """The only obstacle of an image: sides, foot and head, and its cylinder from them."""

    def __init__(self, obstacle: Cylinder, gaze: Pose) -> None:
        self.tables = traced([obstacle], gaze)
        (blob,) = self.tables.blobs
        self.sides = blob.sides
        foot, head = blob.rims
        self.foot, self.head = (foot, 0.0, NEAR), (head, 0.30, FAR)

    def candidate(self, *rims, prior=TYPICAL_RADIUS):
        return candidate_of(self.sides, rims, self.tables.points, prior)

    def located(self, candidates, view=None, unit=1.0):
        p = parameter_record(replace(NOISE, unit=unit))[0]
        fit(candidates, self.tables.points, (self.tables.view if view is None else view)[0], p)
        return candidates[0]


@settings(max_examples=30)
@given(
    distance=st.floats(0.6, 2.2),
    bearing=st.floats(-25.0, 25.0),
    radius=st.floats(0.05, 0.12),
    tilt=st.floats(-0.45, -0.25),
)
def test_foot_head_and_both_agree_within_their_uncertainty(distance, bearing, radius, tilt) -> None:
    image = Image(at(distance, bearing, "red", radius), pose(tilt=tilt))
    rims = (image.foot,), (image.head,), (image.foot, image.head)
    result = [image.located(image.candidate(*cues)) for cues in rims]
    for fitted in result:
        errors = fitted.cylinder - (radians(bearing), distance, radius)
        assert (np.abs(errors) < 4.0 * np.sqrt(np.diag(fitted.covariance))).all()
        assert np.linalg.eigvalsh(fitted.covariance).min() > 0.0
    assert result[2].covariance[1, 1] <= min(c.covariance[1, 1] for c in result[:2])


def test_both_sides_alone_give_the_distance_of_the_typical_radius() -> None:
    image = Image(at(1.5, 0.0, "red", 0.085), pose(tilt=-0.3))
    fitted = image.located(image.candidate())
    assert fitted.cylinder[1] == pytest.approx(1.5, rel=0.04)
    assert fitted.covariance[1, 1] ** 0.5 == pytest.approx(1.5 * 0.02 / 0.085, rel=0.1)


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
    image = Image(at(1.5, 15.0, "red"), gaze)
    blurred = view_of(CAMERA, replace(gaze, **rates), replace(EXACT, **sigma), shutter=0.01)
    exact, vague = (
        image.located(image.candidate(image.foot, image.head), view).covariance
        for view in (None, blurred)
    )
    slack = 0.05 * np.linalg.eigvalsh(exact).min()  # they are linearised apart
    assert np.linalg.eigvalsh(vague - exact).min() > -slack
    assert np.linalg.det(vague) > 1.05 * np.linalg.det(exact)


def test_place_in_the_robot_frame_follows_the_camera() -> None:
    obstacle = at(1.4, 35.0, "blue")
    gaze = pose(pan=radians(20.0), tilt=-0.3, position=(0.2, -0.3, 0.45))
    image = Image(obstacle, gaze)
    fitted = image.located(image.candidate(image.foot, image.head))
    camera = (0.2, -0.3, float(image.tables.view[0].heading))
    cylinder, P = fitted.cylinder, fitted.covariance
    distance, bearing, covariance, by_radius = polar_in_robot(cylinder, P, camera)
    expected = true_polar(obstacle)
    assert abs(distance - expected[0]) < 4.0 * covariance[0, 0] ** 0.5
    assert abs(bearing - expected[1]) < 4.0 * covariance[1, 1] ** 0.5
    # The Jacobian to polar coordinates about R, by finite differences.
    J = np.zeros((2, 2))
    for j in range(2):
        step = 1e-6 * np.eye(3)[j]
        plus, minus = (polar_in_robot(cylinder + e, P, camera) for e in (step, -step))
        J[:, j] = (plus[0] - minus[0]) / 2e-6, (plus[1] - minus[1]) / 2e-6
    assert covariance == pytest.approx(J @ P[:2, :2] @ J.T, rel=1e-5)
    assert by_radius == pytest.approx(J @ P[:2, 2] / P[2, 2], rel=1e-5)


def test_cylinders_interpenetrate_when_their_axes_are_too_close() -> None:
    here = np.array([0.1, 1.0, 0.1])
    for step in (0.0, 0.01, 0.1, 0.4):
        aside = here + 2.0 * np.arcsin(0.5 * step) * np.eye(3)[0]
        behind = here + step * np.eye(3)[1]
        for separation in (0.85, 0.3):
            for tolerance in (0.0, 0.2):
                near = step < separation * 0.2
                assert interpenetrate(here, aside, tolerance, separation) is near
                near = step - tolerance < separation * 0.2
                assert interpenetrate(here, behind, tolerance, separation) is near
                assert interpenetrate(behind, here, tolerance, separation) is near


@pytest.mark.parametrize("unit", [0.3, 3.15])
def test_a_scene_of_another_size_is_located_alike(unit: float) -> None:
    """Lengths of candidates are in units of length."""
    gaze = pose(tilt=-0.3)
    image = Image(at(1.5, 5.0, "red"), gaze)
    small, large = (
        image.located(
            image.candidate(image.foot, image.head),
            view_of(
                CAMERA,
                replace(gaze, position=size * gaze.position),
                replace(EXACT, height_sigma=size * 0.004),
                unit=size,
            ),
            size,
        )
        for size in (1.0, unit)
    )
    scale = np.array([1.0, unit, unit])
    assert large.cylinder == pytest.approx(scale * small.cylinder, rel=1e-6)
    assert large.covariance == pytest.approx(np.outer(scale, scale) * small.covariance, rel=1e-5)
