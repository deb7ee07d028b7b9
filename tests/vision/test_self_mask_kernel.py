import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, pose, rays
from vision.self_mask_kernel import MIN_DEPTH, outline

CENTRES, RADII = np.array([[0.0, 0.09, 0.38], [0.01, 0.1, 0.25]]), np.array([0.03, 0.045])
MIDDLE = np.array([0.5 * CAMERA.width, 0.5 * CAMERA.height, CAMERA.focal])


@given(pan=st.floats(0.3, 1.7), tilt=st.floats(-1.0, 0.0))
def test_compiled_and_plain_agree(pan, tilt):
    view = pose(pan, tilt, position=(0.0, 0.03, 0.47))
    arguments = (CENTRES, RADII, view.position, view.rotation, MIDDLE)
    np.testing.assert_allclose(outline(*arguments), outline.py_func(*arguments), rtol=1e-9)


@given(pan=st.floats(0.9, 1.7), tilt=st.floats(-0.8, -0.2))
def test_points_lie_beyond_the_tangents_to_their_sphere(pan, tilt):
    """No ray through a point of the polygon meets the sphere, and its corners are not far off."""
    view = pose(pan, tilt, position=(0.0, 0.03, 0.47))
    points = outline(CENTRES, RADII, view.position, view.rotation, MIDDLE)
    for centre, radius, polygon in zip(CENTRES, RADII, points.reshape(-1, 12, 2), strict=False):
        local = (centre - view.position) @ view.rotation
        if local[2] - 1.1 * radius < MIN_DEPTH or np.abs(polygon).max() >= 4096.0:
            continue
        tangents = rays(CAMERA, polygon[:, 0], polygon[:, 1])
        tangents /= np.linalg.norm(tangents, axis=1)[:, None]
        miss = np.linalg.norm(np.cross(tangents, local), axis=1)
        assert (miss > radius).all()
        assert (miss < 1.05 * radius).all()
