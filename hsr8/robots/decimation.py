"""Meshes with fewer triangles, by clustering of their vertices."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Triangles = NDArray[np.int64]

MIN_CELLS = 6  # along the longest side of a mesh, so that small parts remain


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
