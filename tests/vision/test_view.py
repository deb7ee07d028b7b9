from math import radians, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, pose, rays
from vision.camera import PinholeCamera
from vision.view import angles, level, project, resolution, view_of

gazes = st.builds(
    pose, pan=st.floats(-1.5, 1.5), tilt=st.floats(-1.0, 0.3), roll=st.floats(-0.1, 0.1)
)
columns, rows = st.floats(1.0, 319.0), st.floats(1.0, 239.0)


def level_part(gaze, u, v):
    """Horizontal part of the ray through a pixel; straight down there is no azimuth."""
    return np.linalg.norm((gaze.rotation @ rays(CAMERA, u, v))[:2])


@given(gaze=gazes, u=columns, v=rows)
def test_angles_and_pixels_invert_each_other(gaze, u, v) -> None:
    view = view_of(CAMERA, gaze)[0]
    azimuth, slope = angles(view, u, v)
    back_u, back_v, ahead = project(view, *level(view, azimuth), slope)
    if level_part(gaze, u, v) < 0.02:
        return
    assert ahead
    assert back_u == pytest.approx(u, abs=1e-5)
    assert back_v == pytest.approx(v, abs=1e-5)


@given(gaze=gazes, u=columns, v=rows)
def test_angles_are_those_of_the_ray_of_the_camera(gaze, u, v) -> None:
    view = view_of(CAMERA, gaze)[0]
    X, Y, Z = gaze.rotation @ rays(CAMERA, u, v)
    if level_part(gaze, u, v) < 0.02:
        return
    azimuth, slope = angles(view, u, v)
    assert np.exp(1j * (azimuth + view.heading)) == pytest.approx((X + 1j * Y) / np.hypot(X, Y))
    assert slope == pytest.approx(Z / np.hypot(X, Y), abs=1e-12)


@given(gaze=gazes, x=st.floats(0.4, 3.0), offset=st.floats(-0.6, 0.6))
def test_a_vertical_line_has_one_azimuth_and_slopes_give_its_distance(gaze, x, offset) -> None:
    view = view_of(CAMERA, gaze)[0]
    direction = view.heading + offset
    for z in (0.0, 0.1, 0.3):
        point = np.array([x * np.cos(direction), x * np.sin(direction), z])
        local = (point - gaze.position) @ gaze.rotation
        if local[2] < 0.05:
            continue
        azimuth, slope = angles(view, *CAMERA.project(local).tolist())
        assert azimuth == pytest.approx(offset, abs=1e-9)
        assert (z - view.position[2]) / slope == pytest.approx(x, rel=1e-9)


@given(gaze=gazes, u=columns, v=rows)
def test_resolution_is_the_derivative_of_the_angles(gaze, u, v) -> None:
    view, eps = view_of(CAMERA, gaze)[0], 1e-4
    if level_part(gaze, u, v) < 0.05:
        return
    au, av, su, sv = resolution(view, u, v)
    for (du, dv), azimuth, slope in (((eps, 0.0), au, su), ((0.0, eps), av, sv)):
        after, before = angles(view, u + du, v + dv), angles(view, u - du, v - dv)
        assert abs(after[0] - before[0]) / (2 * eps) == pytest.approx(azimuth, rel=1e-3, abs=1e-7)
        assert abs(after[1] - before[1]) / (2 * eps) == pytest.approx(slope, rel=1e-3, abs=1e-7)


def test_field_of_view_is_the_angle_between_the_outermost_rays() -> None:
    camera = PinholeCamera.from_vertical_fov(320, 240, radians(70.0))
    assert camera.vertical_fov == pytest.approx(radians(70.0))
    half = 0.5 * camera.horizontal_fov
    border = camera.project(np.array([[tan(half), 0.0, 1.0], [-tan(half), 0.0, 1.0]]))
    assert border == pytest.approx(np.array([[320.0, 120.0], [0.0, 120.0]]))


def test_points_behind_the_camera_have_no_pixel() -> None:
    assert np.isnan(CAMERA.project(np.array([[0.0, 0.0, -1.0], [0.3, 0.1, 0.0]]))).all()
