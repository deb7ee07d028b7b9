"""A small humanoid with visual meshes of many triangles, and without a visual shape on one foot."""

from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import SubElement

import numpy as np

from tests.hsr8.robots.small_humanoid import SmallHumanoid

RED, WHITE = "0.9 0.1 0.1 1", "0.9 0.9 0.9 1"
RADIUS = 0.08  # of the meshes, before their scale [m]
SMALL = SmallHumanoid()


def write_robot(folder: Path) -> str:
    """Write description, model and mesh; return the description."""
    element = SMALL.element()
    folder.joinpath("ball.obj").write_text(ball())
    assets = SubElement(element, "asset")
    SubElement(assets, "mesh", name="ball", file="ball.obj")
    SubElement(assets, "mesh", name="egg", file="ball.obj", scale="0.7 0.7 1.4", refpos="0 0 .02")
    visual = {"type": "mesh", "group": "2", "contype": "0", "conaffinity": "0", "mass": "0"}
    for body in element.iter("body"):
        turned = {"euler": "0.2 0.3 0.4", "pos": "0.01 0.02 0.03", **visual}
        for geom in list(body.findall("geom")):
            geom.set("group", "3")
            geom.set("rgba", RED)
        if body.get("name") == "torso":
            SubElement(body, "geom", mesh="ball", rgba=RED, **visual)
            SubElement(body, "geom", mesh="egg", rgba=WHITE, **turned)
        elif body.get("name") == "l_knee_link":
            SubElement(body, "geom", mesh="egg", rgba=WHITE, **turned)
    folder.joinpath("robot.xml").write_text(ElementTree.tostring(element, encoding="unicode"))
    left, right = SMALL.feet()
    file = folder / "robot.toml"
    shoulders = 'shoulders = ["l_shoulder_pitch", "r_shoulder_pitch"]'
    file.write_text(f'model = "robot.xml"\nfeet = ["{left}", "{right}"]\n{shoulders}\n')
    return str(file)


def ball() -> str:
    """OBJ text of a sphere."""
    return "\n".join(
        [
            *("v " + " ".join(map(repr, map(float, corner))) for corner in sphere(RADIUS)[0]),
            *("f " + " ".join(str(k + 1) for k in triangle) for triangle in sphere(RADIUS)[1]),
        ]
    )


def sphere(radius: float, rings: int = 60) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and triangles (m, 3) of a closed sphere, about its centre."""
    tilt = np.linspace(0.0, np.pi, rings + 1)[1:-1]
    turn = np.linspace(0.0, 2.0 * np.pi, 2 * rings, endpoint=False)
    tilts, turns = np.meshgrid(tilt, turn, indexing="ij")
    across = np.sin(tilts)
    around = np.stack([across * np.cos(turns), across * np.sin(turns), np.cos(tilts)], axis=-1)
    n = len(turn)
    corners = np.vstack([around.reshape(-1, 3), [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0)]])
    top, bottom = len(corners) - 2, len(corners) - 1
    triangles = [(top, k, (k + 1) % n) for k in range(n)]
    last = len(corners) - 2 - n
    triangles += [(bottom, last + (k + 1) % n, last + k) for k in range(n)]
    for ring in range(len(tilt) - 1):
        for k in range(n):
            a, b = ring * n + k, ring * n + (k + 1) % n
            triangles += [(a, a + n, b), (b, a + n, b + n)]
    return radius * corners, np.array(triangles)
