from math import radians, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, rays
from vision.camera import PinholeCamera


@given(u=st.floats(0.0, 320.0), v=st.floats(0.0, 240.0), depth=st.floats(0.05, 20.0))
def test_points_on_a_ray_project_back_to_its_pixel(u: float, v: float, depth: float) -> None:
    point = depth * rays(CAMERA, [u], [v])
    assert CAMERA.project(point) == pytest.approx(np.array([[u, v]]), abs=1e-9)


def test_field_of_view_is_the_angle_between_the_outermost_rays() -> None:
    camera = PinholeCamera.from_vertical_fov(320, 240, radians(70.0))
    assert camera.vertical_fov == pytest.approx(radians(70.0))
    half = 0.5 * camera.horizontal_fov
    border = camera.project(np.array([[tan(half), 0.0, 1.0], [-tan(half), 0.0, 1.0]]))
    assert border == pytest.approx(np.array([[320.0, 120.0], [0.0, 120.0]]))


def test_points_behind_the_camera_have_no_pixel() -> None:
    assert np.isnan(CAMERA.project(np.array([[0.0, 0.0, -1.0], [0.3, 0.1, 0.0]]))).all()
