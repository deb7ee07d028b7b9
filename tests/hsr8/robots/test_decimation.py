import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.robots.meshes import decimated
from tests.hsr8.robots.mesh_humanoid import sphere

CORNERS, TRIANGLES = sphere(1.0, rings=30)


@settings(max_examples=30, deadline=None)
@given(cell=st.floats(0.02, 10.0), size=st.floats(1e-3, 1e3))
def test_a_simpler_mesh_stays_within_a_cell_of_the_surface(cell, size):
    vertices, triangles = decimated(size * CORNERS, TRIANGLES, size * cell)
    assert 0 < len(triangles) <= len(TRIANGLES)
    assert sorted(set(triangles.ravel())) == list(range(len(vertices)))
    assert (np.diff(np.sort(triangles), axis=1) > 0).all()
    away = np.abs(np.linalg.norm(vertices, axis=1) - size)
    assert away.max() <= np.sqrt(3.0) * size * min(cell, 2.0 / 6.0)


def test_triangles_keep_their_orientation():
    vertices, triangles = decimated(CORNERS, TRIANGLES, 0.15)
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    outward = np.einsum("nk,nk->n", np.cross(b - a, c - a), a + b + c)
    assert (outward > 0.0).mean() > 0.98
    assert np.einsum("nk,nk->n", np.cross(a, b), c).sum() / 6.0 > 0.9 * 4.0 / 3.0 * np.pi


def test_both_sides_of_a_thin_plate_remain():
    grid = np.stack(np.meshgrid(np.arange(20.0), np.arange(20.0)), axis=-1).reshape(-1, 2)
    plate = np.vstack([np.column_stack([grid, np.full(400, z)]) for z in (0.0, 0.1)])
    quads = [r * 20 + c for r in range(19) for c in range(19)]
    top = [t for q in quads for t in ((q, q + 1, q + 20), (q + 1, q + 21, q + 20))]
    both = np.array(top + [(400 + a, 400 + c, 400 + b) for a, b, c in top])
    vertices, triangles = decimated(plate, both, 2.0)
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    up = np.cross(b - a, c - a)[:, 2]
    assert (up > 0).sum() == (up < 0).sum() > 0
