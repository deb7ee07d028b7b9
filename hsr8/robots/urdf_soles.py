"""Soles of a URDF robot: stated, or from the shapes of its feet, as mirror images of each other."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.description import RobotDescription, SoleRectangle
from hsr8.robots.key_mistake import KeyMistake
from hsr8.robots.urdf_base import Base
from hsr8.robots.urdf_elements import Shape
from hsr8.robots.urdf_joints import Joints
from hsr8.robots.urdf_shapes import GeomBuilder, shape_points

Array = NDArray[np.float64]
FLAT_FRACTION = 0.5  # of the foot's outline that a flat sole covers
THICKNESS = 0.004  # height of the points above the lowest one that belong to a sole [m]
MIN_EDGE = 0.01  # a narrower sole cannot carry a robot [m]
EXACT, CLOSE, MAX_DIFFERENCE = 1e-5, 0.002, 0.02  # of two soles from mirror images [m]


class Sole(NamedTuple):
    """Rectangle of a sole in the directions of the base at zero angles [m].

    Attributes:
        front, back: edges, forward of the origin.
        left, right: edges, to the left of the origin.
        height: above the origin.
    """

    front: float
    back: float
    left: float
    right: float
    height: float

    def mirrored(self) -> "Sole":
        """Return the mirror image about the plane between left and right."""
        return self._replace(left=-self.right, right=-self.left)

    def shifted(self, vector: Array) -> "Sole":
        """Return the sole moved by a vector, shape (3,) [m]."""
        x, y, z = vector.tolist()
        return Sole(self.front + x, self.back + x, self.left + y, self.right + y, self.height + z)

    @property
    def size(self) -> tuple[float, float]:
        """Length and width [m]."""
        return self.front - self.back, self.left - self.right


def sole_of_points(points: Array) -> Sole:
    """Bounding rectangle of the lowest 4 mm of a foot; `points` has shape (n, 3) [m]."""
    height = float(points[:, 2].min())
    low = points[points[:, 2] < height + THICKNESS]
    front, left = (float(v) for v in low[:, :2].max(axis=0))
    back, right = (float(v) for v in low[:, :2].min(axis=0))
    return Sole(front, back, left, right, height)


def find_soles(
    joints: Joints, base: Base, description: RobotDescription, geoms: GeomBuilder
) -> tuple[tuple[Sole, Sole], list[str]]:
    """Find the soles in the base at the angles `zero`, and notes on them.

    Raises:
        ModelError: a foot has no shape, its sole is too narrow, or the soles are not mirror images.
    """
    tree, feet = joints.tree, description.feet
    poses = {link: base.root_pose @ pose for link, pose in tree.poses(description.zero).items()}
    sole = description.sole
    if isinstance(sole, SoleRectangle):
        left = Sole(sole.front, sole.back, sole.left, sole.right, sole.height)
        origins = [poses[foot][:3, 3] for foot in feet]
        pair, notes = (left.shifted(origins[0]), left.mirrored().shifted(origins[1])), []
    else:
        names = sole or (None, None)
        finder = _SoleFinder(joints, poses, geoms)
        pair = finder.sole(feet[0], names[0]), finder.sole(feet[1], names[1])
        notes = finder.notes
    soles, mirror_notes = mirror_soles(*pair, feet)
    return soles, [*notes, *mirror_notes]


def mirror_soles(
    left: Sole, right: Sole, feet: tuple[str, str]
) -> tuple[tuple[Sole, Sole], list[str]]:
    """Return the two soles as exact mirror images, with notes on how they differed.

    Args:
        left: left sole, relative to the base.
        right: right sole, relative to the base.
        feet: names, for the message.

    Raises:
        KeyMistake: a sole is too narrow, or they differ by more than 2 cm.
    """
    for foot, sole in zip(feet, (left, right), strict=True):
        if min(sole.size) < MIN_EDGE:
            length, width = sole.size
            raise KeyMistake(
                f"sole: foot '{foot}' has {100 * length:.1f} x {100 * width:.1f} cm, from the "
                f"lowest {1e3 * THICKNESS:.0f} mm of its shapes at zero angles; expected a flat "
                "sole: state `zero` if the feet are not flat there, else `sole`"
            )
    image = right.mirrored()
    difference = float(np.abs(np.subtract(left, image)).max())
    if difference <= EXACT:
        return (left, left.mirrored()), []
    if difference > MAX_DIFFERENCE:
        edge = Sole._fields[int(np.abs(np.subtract(left, image)).argmax())]
        raise KeyMistake(
            f"sole: those of '{feet[0]}' and '{feet[1]}' are not mirror images: {edge} differs "
            f"by {1e3 * difference:.1f} mm, got {_text(left)} and mirrored {_text(image)}; "
            f"expected at most {1e3 * MAX_DIFFERENCE:.0f} mm: state `sole`, or check `feet` and "
            "`zero`"
        )
    mean = Sole(*(0.5 * np.add(left, image)).tolist())
    warning = "" if difference <= CLOSE else "warning: "
    note = f"{warning}soles differ by {1e3 * difference:.1f} mm: mean of both"
    return (mean, mean.mirrored()), [note]


def _text(sole: Sole) -> str:
    return ", ".join(f"{key} {value:.4f}" for key, value in sole._asdict().items())


class _SoleFinder:
    """Soles from shapes; `poses` has every link in the base at zero angles."""

    def __init__(self, joints: Joints, poses: dict[str, Array], geoms: GeomBuilder) -> None:
        self._tree = joints.tree
        self._poses = poses
        self._geoms = geoms
        self.notes: list[str] = []

    def sole(self, foot: str, name: str | None) -> Sole:
        """Sole of a foot from its shape or link `name`, or from all its shapes.

        Collision shapes count, visual ones where these are missing or make no flat sole.
        """
        sole = None
        for kind in ("collision", "visual"):
            points = [self._points(shape, pose) for shape, pose in self._shapes(foot, kind, name)]
            if sum(map(len, points)) == 0:
                continue
            candidate = sole_of_points(np.vstack(points))
            if sole is None or min(candidate.size) >= MIN_EDGE:
                sole, source, outline = candidate, kind, np.ptp(np.vstack(points)[:, :2], axis=0)
            if min(sole.size) >= MIN_EDGE:
                break
        if sole is None:
            raise self._shapeless(foot, name)
        length, width = sole.size
        self.notes.append(
            f"sole of '{foot}' from its {source} shapes: {100 * length:.1f} x {100 * width:.1f} cm"
        )
        if length * width < FLAT_FRACTION * float(np.prod(outline)):
            percent = 100 * length * width / float(np.prod(outline))
            self.notes.append(
                f"warning: the sole of '{foot}' covers {percent:.0f} % of the foot's outline: "
                "state `zero` if the foot is not flat there"
            )
        return sole

    def _shapes(self, foot: str, kind: str, name: str | None) -> Iterator[tuple[Shape, Array]]:
        """Shapes of a foot with their pose in the base."""
        for link, _ in self._tree.group(self._tree.carrier(foot)):
            for shape in getattr(self._tree.urdf.links[link], kind):
                if name in (None, link, shape.name):
                    yield shape, self._poses[link] @ shape.pose

    def _points(self, shape: Shape, pose: Array) -> Array:
        return shape_points(shape, pose, self._geoms.file(shape))

    def _shapeless(self, foot: str, name: str | None) -> ModelError:
        shapes = [s for k in ("collision", "visual") for s, _ in self._shapes(foot, k, None)]
        if name is not None:
            choices = sorted({shape.name for shape in shapes if shape.name})
            return KeyMistake(
                f"sole: foot '{foot}' has no shape or link '{name}'; expected one of its named "
                f"shapes: {', '.join(choices) or 'none, it has none'}"
            )
        meshes = [shape.mesh for shape in shapes if shape.mesh]
        remedy = "state `sole` = {front, back, left, right, height}"
        if meshes:
            return ModelError(
                f"{self._tree.urdf.file}: foot '{foot}': mesh not found, got '{meshes[0]}'; "
                f"expected the file: state the folder of its package under `packages`, or {remedy}"
            )
        return KeyMistake(f"sole: foot '{foot}' has no shape, so its sole is unknown: {remedy}")
