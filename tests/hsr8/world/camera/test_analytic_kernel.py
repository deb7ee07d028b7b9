import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.world.camera.analytic_kernel import DISTANCE, HIDDEN, MIN_DEPTH, project, project_all
from tests.vision.scene import CAMERA, pose

RADIUS, HEIGHT = 0.08, 0.3
positions = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)).filter(
    lambda p: np.hypot(*p) > 0.2
)


def eye(view, omnidirectional=False):
    size = (CAMERA.width, CAMERA.height, CAMERA.focal, omnidirectional)
    return np.array([*view.position, *view.rotation.ravel(), *size])


def cylinders(seed, n):
    """Random positions from near to far, sizes and kinds."""
    rng = np.random.default_rng(seed)
    there = rng.uniform(-3.0, 3.0, (n, 2))
    there = there[np.argsort(np.hypot(there[:, 0], there[:, 1]))]
    sizes = np.column_stack([rng.uniform(0.05, 0.3, n), rng.uniform(0.3, 0.6, n)])
    return there, sizes, rng.random(n) < 0.3


@given(position=positions, pan=st.floats(-1.5, 1.5), tilt=st.floats(-0.6, 0.2))
def test_a_box_bounds_the_projected_edges_of_the_cylinder(position, pan, tilt):
    view = pose(pan, tilt)
    left, top, right, bottom, cut = project(*position, RADIUS, HEIGHT, False, eye(view))
    across = np.array([-position[1], position[0]]) * RADIUS / np.hypot(*position)
    points = np.array(
        [[*(position + s * across), z] for s in (-1, 1) for z in (0.0, 0.5 * HEIGHT, HEIGHT)]
    )
    local = (points - view.position) @ view.rotation
    size = np.array([CAMERA.width, CAMERA.height])
    if right == 0.0:
        if (local[:, 2] > MIN_DEPTH).all():
            pixels = CAMERA.project(local)
            assert (pixels.max(axis=0) < 2.0).any() or (pixels.min(axis=0) > size - 2.0).any()
        return
    pixels = CAMERA.project(local)
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    assert cut == ((low < 0.0).any() or (high > size).any())
    assert (left, top) == tuple(np.floor(np.maximum(low, 0.0)))
    assert (right, bottom) == tuple(np.minimum(np.floor(high) + 1.0, size))


@given(turn=st.floats(-3.1, 3.1), offset=st.floats(-0.5, 0.5))
def test_what_is_hidden_is_the_overlap_of_two_intervals_of_azimuth(turn, offset):
    """In every direction: azimuths meet at half a turn."""
    near, far = 1.0, 2.0
    there = np.array(
        [
            [near * np.cos(turn), near * np.sin(turn)],
            [far * np.cos(turn + offset), far * np.sin(turn + offset)],
        ]
    )
    sizes = np.array([[0.2, HEIGHT], [0.2, HEIGHT]])
    views = project_all(there, sizes, np.zeros(2, bool), eye(pose()))
    a, b = np.arcsin(0.2 / near), np.arcsin(0.2 / far)
    overlap = min(b, offset + a) - max(-b, offset - a)
    assert views[:, DISTANCE] == pytest.approx([near, far])
    assert views[0, HIDDEN] == 0.0
    assert views[1, HIDDEN] == pytest.approx(max(0.0, overlap / (2.0 * b)), abs=1e-9)
