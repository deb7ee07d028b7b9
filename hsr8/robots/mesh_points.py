"""Vertices and triangles of mesh files, and the file of a ``package://`` URI."""

import os
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree

import coal
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.key_mistake import KeyMistake

Array = NDArray[np.float64]
Triangles = NDArray[np.int32]


def package_folders(packages: Mapping[str, str], folder: Path) -> dict[str, Path]:
    """Folder of each package of a description; relative ones are next to its file.

    Raises:
        KeyMistake: a folder does not exist.
    """
    folders = {name: folder / os.path.expanduser(text) for name, text in packages.items()}
    for name, path in folders.items():
        if not os.path.isdir(path):
            raise KeyMistake(
                f"packages.{name}: not a folder, got '{path}'; expected the package's folder"
            )
    return folders


def find_mesh(uri: str, urdf: Path, packages: Mapping[str, Path]) -> Path | None:
    """Find the file of a mesh.

    ``package://NAME/FILE`` is searched in the folder of the package if it is known, else as
    ``NAME/FILE``, then as ``FILE``, in every folder from that of the URDF file upwards; paths
    without a scheme as they are.

    Args:
        uri: of the mesh.
        urdf: file that names it.
        packages: known folders.

    Returns:
        Its path, or None if the file does not exist.
    """
    scheme, _, rest = uri.rpartition("://")
    name, _, tail = rest.partition("/")
    if scheme in ("package", "model") and name in packages:
        candidates = [packages[name] / tail]
    else:
        tails = (rest, tail) if scheme in ("package", "model") else (rest,)
        folders = list(urdf.resolve().parents)
        candidates = [folder / text for text in tails if text for folder in folders]
    return next((path for path in candidates if path.is_file()), None)


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
