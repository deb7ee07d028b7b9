"""A tetrahedron as a mesh file of every format; its base is 16 x 8 cm at z = 0."""

import struct
from pathlib import Path

import numpy as np

CORNERS = np.array([(0.08, 0.04, 0.0), (0.08, -0.04, 0.0), (-0.08, 0.0, 0.0), (0.0, 0.0, 0.06)])
TRIANGLES = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))
FORMATS = ("binary.stl", "ascii.stl", "mesh.obj", "mesh.dae")


def write_mesh(folder: Path, name: str) -> Path:
    """Write the mesh; the format follows from the name, one of `FORMATS`."""
    file = folder / name
    if name == "binary.stl":
        facets = b"".join(_facet(t) for t in TRIANGLES)
        file.write_bytes(bytes(80) + struct.pack("<I", len(TRIANGLES)) + facets)
    elif name == "ascii.stl":
        file.write_text("solid mesh\n" + "".join(map(_loop, TRIANGLES)) + "endsolid mesh\n")
    elif name == "mesh.obj":
        lines = [f"v {_text(c)}" for c in CORNERS]
        lines += ["f " + " ".join(str(k + 1) for k in t) for t in TRIANGLES]
        file.write_text("\n".join(lines) + "\n")
    else:
        file.write_text(dae())
    return file


def dae(up: str = "Z_UP", unit: float = 1.0) -> str:
    """Text of a DAE file."""
    numbers = " ".join(map(_text, CORNERS))
    indices = " ".join(str(k) for t in TRIANGLES for k in t)
    params = "".join(f'<param name="{c}" type="float"/>' for c in "XYZ")
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="{unit}" name="unit"/><up_axis>{up}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">{numbers}</float_array><technique_common>
<accessor source="#a" count="4" stride="3">{params}</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""


def _text(numbers: object) -> str:
    return " ".join(repr(float(v)) for v in numbers)  # type: ignore[attr-defined]


def _facet(triangle: tuple[int, int, int]) -> bytes:
    return struct.pack("<12fH", 0, 0, 0, *CORNERS[list(triangle)].ravel(), 0)


def _loop(triangle: tuple[int, int, int]) -> str:
    corners = "".join(f"vertex {_text(CORNERS[k])}\n" for k in triangle)
    return f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n"
