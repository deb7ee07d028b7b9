"""Meshes of every format give the same points, in metres and without a turn, and simpler ones."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.robots.file.files import find_mesh, package_folders
from hsr8.robots.file.meshes import decimated, read_mesh
from tests.hsr8.robots.mesh_files import CORNERS, FORMATS, dae, write_mesh
from tests.hsr8.robots.mesh_humanoid import sphere


def sorted_rows(points):
    return points[np.lexsort(points.T)]


@pytest.mark.parametrize("kind", FORMATS)
def test_vertices_are_those_of_the_file(kind, tmp_path):
    vertices, triangles = read_mesh(write_mesh(tmp_path, kind))
    unique = np.unique(vertices.round(6), axis=0)
    np.testing.assert_allclose(sorted_rows(unique), sorted_rows(CORNERS), atol=1e-6)
    assert triangles.shape == (4, 3)
    assert triangles.max() < len(vertices)


@pytest.mark.parametrize("up", ["X_UP", "Y_UP", "Z_UP"])
def test_the_up_axis_of_a_dae_file_is_ignored(up, tmp_path):
    file = tmp_path / "mesh.dae"
    file.write_text(dae(up=up))
    np.testing.assert_allclose(sorted_rows(read_mesh(file)[0]), sorted_rows(CORNERS), atol=1e-6)


def test_the_unit_of_a_dae_file_is_respected(tmp_path):
    file = tmp_path / "mesh.dae"
    file.write_text(dae(unit=0.001))
    expected = sorted_rows(1e-3 * CORNERS)
    np.testing.assert_allclose(sorted_rows(read_mesh(file)[0]), expected, atol=1e-9)


def test_the_package_of_a_uri_is_searched_upwards(tmp_path):
    urdf = tmp_path / "small" / "urdf" / "small.urdf"
    mesh = tmp_path / "small" / "meshes" / "foot.stl"
    for folder in (mesh.parent, urdf.parent):
        folder.mkdir(parents=True)
    mesh.touch()
    assert find_mesh("package://small/meshes/foot.stl", urdf, {}) == mesh
    assert find_mesh("package://other_name/meshes/foot.stl", urdf, {}) == mesh
    assert find_mesh("../meshes/foot.stl", urdf, {}).resolve() == mesh
    assert find_mesh(f"file://{mesh}", urdf, {}) == mesh
    assert find_mesh("package://small/meshes/hand.stl", urdf, {}) is None


def test_a_stated_package_is_the_only_one_searched(tmp_path):
    (tmp_path / "meshes").mkdir()
    packages = package_folders({"small": "meshes"}, tmp_path)
    (tmp_path / "foot.stl").touch()
    uri = "package://small/foot.stl"
    assert find_mesh(uri, tmp_path / "small.urdf", packages) is None
    (tmp_path / "meshes" / "foot.stl").touch()
    assert find_mesh(uri, tmp_path / "small.urdf", packages) == tmp_path / "meshes" / "foot.stl"


SPHERE, TRIANGLES = sphere(1.0, rings=30)


@settings(max_examples=30, deadline=None)
@given(cell=st.floats(0.02, 10.0), size=st.floats(1e-3, 1e3))
def test_a_simpler_mesh_stays_within_a_cell_of_the_surface(cell, size):
    vertices, triangles = decimated(size * SPHERE, TRIANGLES, size * cell)
    assert 0 < len(triangles) <= len(TRIANGLES)
    assert sorted(set(triangles.ravel())) == list(range(len(vertices)))
    assert (np.diff(np.sort(triangles), axis=1) > 0).all()
    away = np.abs(np.linalg.norm(vertices, axis=1) - size)
    assert away.max() <= np.sqrt(3.0) * size * min(cell, 2.0 / 6.0)


def test_triangles_keep_their_orientation():
    vertices, triangles = decimated(SPHERE, TRIANGLES, 0.15)
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
