import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, pose
from vision.view import View

gazes = st.builds(
    pose, pan=st.floats(-1.5, 1.5), tilt=st.floats(-1.0, 0.3), roll=st.floats(-0.1, 0.1)
)
pixels = st.tuples(st.floats(1.0, 319.0), st.floats(1.0, 239.0))


@given(gaze=gazes, pixel=pixels)
def test_angles_and_pixels_invert_each_other(gaze, pixel) -> None:
    view = View(CAMERA, gaze)
    u, v = np.array([pixel[0]]), np.array([pixel[1]])
    back_u, back_v, ahead = view.pixels(*view.angles(u, v))
    if np.linalg.norm((gaze.rotation @ CAMERA.rays(u, v)[0])[:2]) < 0.02:
        return  # straight down there is no azimuth
    assert ahead.all()
    assert back_u == pytest.approx(u, abs=1e-5)
    assert back_v == pytest.approx(v, abs=1e-5)


@given(gaze=gazes, x=st.floats(0.4, 3.0), offset=st.floats(-0.6, 0.6))
def test_a_vertical_line_has_one_azimuth_and_slopes_give_its_distance(gaze, x, offset) -> None:
    view = View(CAMERA, gaze)
    direction = view.heading + offset
    foot = np.array([x * np.cos(direction), x * np.sin(direction), 0.0])
    points = foot + np.array([[0.0, 0.0, z] for z in (0.0, 0.1, 0.3)])
    local = (points - gaze.position) @ gaze.rotation
    if (local[:, 2] < 0.05).any():
        return
    azimuth, slope = view.angles(*CAMERA.project(local).T)
    assert azimuth == pytest.approx(offset, abs=1e-9)
    assert (points[:, 2] - view.height) / slope == pytest.approx(x, rel=1e-9)


@given(gaze=gazes, pixel=pixels)
def test_resolution_is_the_derivative_of_the_angles(gaze, pixel) -> None:
    view = View(CAMERA, gaze)
    u, v, eps = np.array([pixel[0]]), np.array([pixel[1]]), 1e-4
    if np.linalg.norm((gaze.rotation @ CAMERA.rays(u, v)[0])[:2]) < 0.05:
        return
    au, av, su, sv = view.resolution(u, v)
    for (du, dv), azimuth, slope in (((eps, 0.0), au, su), ((0.0, eps), av, sv)):
        after, before = view.angles(u + du, v + dv), view.angles(u - du, v - dv)
        assert abs(after[0] - before[0]) / (2 * eps) == pytest.approx(azimuth, rel=1e-3, abs=1e-7)
        assert abs(after[1] - before[1]) / (2 * eps) == pytest.approx(slope, rel=1e-3, abs=1e-7)
