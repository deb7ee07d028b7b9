"""Vertices and triangles of mesh files."""

from pathlib import Path
from xml.etree import ElementTree

import coal
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError

Array = NDArray[np.float64]
Triangles = NDArray[np.int32]


def read_mesh(path: Path) -> tuple[Array, Triangles]:
    """Read a mesh of any format that Assimp knows, among them STL, OBJ and DAE.

    As in ROS, the up axis of a DAE file is ignored and its unit respected.

    Returns:
        Vertices, shape (n, 3) [m], and triangles as rows of vertex numbers, shape (m, 3).

    Raises:
        ModelError: the file cannot be read.
    """
    try:
        mesh = coal.MeshLoader().load(str(path))
        rows = [mesh.tri_indices(k) for k in range(mesh.num_tris)]
        triangles = np.array([(row[0], row[1], row[2]) for row in rows], dtype=np.int32)
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
