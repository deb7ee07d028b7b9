"""Vertices and triangles of mesh files, and meshes with fewer triangles."""

from pathlib import Path
from xml.etree import ElementTree

import coal
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError

Array = NDArray[np.float64]
Triangles = NDArray[np.int64]

POINTER = b"version https://git-lfs.github.com"
MIN_CELLS = 6  # along the longest side of a mesh, so that small parts remain


def read_mesh(path: Path) -> tuple[Array, Triangles]:
    """Read a mesh of any format that Assimp knows, among them STL, OBJ and DAE.

    As in ROS, the up axis of a DAE file is ignored and its unit respected.

    Returns:
        Vertices, shape (n, 3) [m], and triangles as rows of vertex numbers, shape (m, 3).

    Raises:
        ModelError: the file cannot be read.
    """
    if is_pointer(path):
        raise ModelError(
            f"{path}: a pointer of Git LFS; expected the mesh: fetch it with `git lfs pull`"
        )
    try:
        mesh = coal.MeshLoader().load(str(path))
        rows = [mesh.tri_indices(k) for k in range(mesh.num_tris)]
        triangles = np.array([(row[0], row[1], row[2]) for row in rows], dtype=np.int64)
        vertices = np.array(mesh.vertices(), dtype=float).reshape(-1, 3) * _unit(path)
    except (ValueError, RuntimeError, ElementTree.ParseError) as error:
        raise ModelError(f"{path}: cannot be read: {error}; expected a mesh file") from error
    return vertices, triangles.reshape(-1, 3)


def is_binary_stl(path: Path) -> bool:
    """Return whether MuJoCo can read an STL file: it reads binary ones only."""
    with path.open("rb") as stream:
        header = stream.read(84)
    count = int.from_bytes(header[80:84], "little")
    return len(header) == 84 and path.stat().st_size == 84 + 50 * count


def is_pointer(path: Path) -> bool:
    """Return whether a file is a pointer of Git LFS, in the place of a file that is not fetched."""
    with path.open("rb") as stream:
        return stream.read(len(POINTER)) == POINTER


def _unit(path: Path) -> float:
    """Length unit of a DAE file [m]; 1 for other formats."""
    if path.suffix.lower() != ".dae":
        return 1.0
    for _, element in ElementTree.iterparse(path):
        if element.tag.endswith("}unit"):
            return float(element.get("meter", "1"))
        if element.tag.endswith("}asset"):
            break
    return 1.0


def decimated(vertices: Array, triangles: Triangles, cell: float) -> tuple[Array, Triangles]:
    """Return a mesh whose vertices within one cell of a grid are merged at their mean.

    Only vertices whose normals point to the same side are merged, so that thin walls keep both.

    Rossignac & Borrel, "Multi-resolution 3D approximations for rendering complex scenes", 1993.

    Args:
        vertices: (n, 3) [m].
        triangles: indices of their corners (m, 3).
        cell: side of a cell, smaller for a mesh of few cells [m].

    Returns:
        Vertices (k, 3) [m] and triangles (l, 3).
    """
    lowest, sides = vertices.min(axis=0), np.ptp(vertices, axis=0)
    cell = min(cell, float(sides.max()) / MIN_CELLS)
    if cell <= 0.0:
        return vertices, triangles
    columns, rows, _ = np.floor(sides / cell).astype(np.int64) + 1
    x, y, z = np.floor((vertices - lowest) / cell).astype(np.int64).T
    cells = x + columns * (y + rows * z)
    _, cluster, counts = np.unique(
        6 * cells + _side(vertices, triangles), return_inverse=True, return_counts=True
    )
    means = np.column_stack([np.bincount(cluster, axis) for axis in vertices.T]) / counts[:, None]
    merged = cluster[triangles]
    a, b, c = merged.T
    merged = merged[(a != b) & (b != c) & (c != a)]
    first = merged.argmin(axis=1)[:, None]  # the corner that begins, so that equal ones are equal
    merged = np.take_along_axis(merged, (first + np.arange(3)) % 3, axis=1)
    used, numbers = np.unique(np.unique(merged, axis=0), return_inverse=True)
    return means[used], numbers.reshape(-1, 3)


def _side(vertices: Array, triangles: Triangles) -> Triangles:
    """Return the axis of the largest component of each normal, 0 to 5 with its sign (n,)."""
    a, b, c = (vertices[corner] for corner in triangles.T)
    doubled = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    count, corners = len(vertices), triangles.ravel()
    normals = np.column_stack([np.bincount(corners, part, count) for part in doubled.T])
    axis = np.abs(normals).argmax(axis=1)
    side: Triangles = 2 * axis + (normals[np.arange(count), axis] < 0.0)
    return side
