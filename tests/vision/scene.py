"""A small ray caster: images of cylinders on a grey floor, without OpenGL."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, hypot, radians, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vision.blob import find_blobs
from vision.camera import PinholeCamera
from vision.color import COLOR_CLASSES, ColorTable
from vision.outline import trace
from vision.parameters import PoseParameters, VisionParameters
from vision.tables import ANY, OUTSIDE, Blob, Candidate, Points, add_rim, copy_side
from vision.view import view_of

FLOOR = (0.62, 0.61, 0.58)
SKY = (0.05, 0.05, 0.06)
CAMERA = PinholeCamera.from_vertical_fov(320, 240, radians(70.0))
HEIGHT = 0.47


@dataclass(frozen=True)
class Pose:
    """A camera pose in R."""

    rotation: NDArray[np.float64]
    position: NDArray[np.float64]
    pan_rate: float = 0.0
    tilt_rate: float = 0.0


@dataclass(frozen=True)
class Cylinder:
    """An upright cylinder from `low` to `high`, painted in a colour class."""

    x: float
    y: float
    color: str
    radius: float = 0.08
    low: float = 0.0
    high: float = 0.30


def beacon(x: float, y: float, top: str, bottom: str) -> list[Cylinder]:
    return [Cylinder(x, y, bottom, 0.05, 0.0, 0.30), Cylinder(x, y, top, 0.05, 0.30, 0.60)]


def pose(
    pan: float = 0.0,
    tilt: float = 0.0,
    roll: float = 0.0,
    position: tuple[float, float, float] = (0.0, 0.0, HEIGHT),
) -> Pose:
    """Pose of a camera that looks `pan` to the left and `tilt` upwards [rad]."""
    cy, sy, cp, sp, cr, sr = cos(pan), sin(pan), cos(tilt), sin(tilt), cos(roll), sin(roll)
    Rz = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
    Ry = np.array([[cp, 0.0, -sp], [0.0, 1.0, 0.0], [sp, 0.0, cp]])
    Rx = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
    level = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    return Pose(Rz @ Rx @ Ry @ level, np.array(position))


def uncertain(sigma: float) -> VisionParameters:
    """Parameters for poses with a standard deviation of tilt and roll [rad]."""
    return VisionParameters(pose=PoseParameters(sigma, sigma, 0.2 * sigma, 0.003))


def rays(camera: PinholeCamera, u: ArrayLike, v: ArrayLike) -> NDArray[np.float64]:
    """Directions in the camera frame (..., 3), z = 1, of image points (u, v) [pixel]."""
    x = (np.asarray(u, float) - 0.5 * camera.width) / camera.focal
    y = (np.asarray(v, float) - 0.5 * camera.height) / camera.focal
    return np.stack([x, y, np.ones_like(x)], axis=-1)


def paint(
    cylinders: Sequence[Cylinder],
    view: Pose,
    brightness: float = 1.0,
    camera: PinholeCamera = CAMERA,
) -> NDArray[np.uint8]:
    """RGB image of `things`; sides are shaded by the angle of incidence."""
    v, u = np.mgrid[0 : camera.height, 0 : camera.width]
    directions = rays(camera, u + 0.5, v + 0.5) @ view.rotation.T
    X, Y, Z = np.moveaxis(directions, -1, 0)
    px, py, pz = view.position.tolist()
    down = Z < -1e-9
    nearest = np.where(down, -pz / np.where(down, Z, -1.0), np.inf)
    image = np.where(down[..., None], FLOOR, SKY)
    a = np.maximum(X * X + Y * Y, 1e-12)
    for cylinder in sorted(cylinders, key=lambda c: (c.x, c.y, c.low)):
        ox, oy = px - cylinder.x, py - cylinder.y
        b, c = X * ox + Y * oy, ox * ox + oy * oy - cylinder.radius**2
        hit = b * b - a * c > 0.0
        side = (-b - np.sqrt(np.where(hit, b * b - a * c, 0.0))) / a
        z = pz + side * Z
        hit &= (side > 0.0) & (z >= cylinder.low) & (z < cylinder.high) & (side < nearest)
        facing = -(X * (ox + side * X) + Y * (oy + side * Y)) / (cylinder.radius * np.sqrt(a))
        shade = 0.45 + 0.5 * np.clip(facing, 0.0, 1.0)
        lid = np.where(down, (cylinder.high - pz) / np.where(down, Z, -1.0), -1.0)
        on_lid = (
            (lid > 0.0)
            & (np.hypot(ox + lid * X, oy + lid * Y) <= cylinder.radius)
            & (lid < nearest)
            & ~(hit & (side < lid))
        )
        rgb = np.array(COLOR_CLASSES[cylinder.color].rgb)
        image[hit] = rgb * shade[hit][:, None]
        image[on_lid] = rgb
        nearest = np.where(on_lid, lid, np.where(hit, side, nearest))
    return np.clip(np.round(255.0 * brightness * image), 0, 255).astype(np.uint8)


def at(distance: float, bearing_deg: float, color: str, radius: float = 0.08) -> Cylinder:
    """An obstacle at a distance [m] and bearing [degree] from the origin of R."""
    bearing = radians(bearing_deg)
    return Cylinder(distance * cos(bearing), distance * sin(bearing), color, radius)


@dataclass(frozen=True)
class Traced:
    """Tables of an image: blobs with their edges, see `vision.tables`."""

    blobs: NDArray[np.record]
    runs: NDArray[np.int32]
    extents: NDArray[np.int32]
    padded: NDArray[np.uint8]
    points: Points
    view: NDArray[np.record]

    def named(self, color: str) -> np.record:
        """The only blob of a colour."""
        (blob,) = self.blobs[self.blobs["label"] == 1 + list(COLOR_CLASSES).index(color)]
        return blob

    def rim(self, rim: np.record) -> tuple[NDArray[np.float64], ...]:
        """Azimuth, slope and outer label of the points of a rim."""
        return tuple(values[rim.first : rim.last] for values in self.points)


def traced(
    cylinders: Sequence[Cylinder], gaze: Pose, min_area: int = 20, edge_sigma: float = 0.35
) -> Traced:
    return traced_in(paint(cylinders, gaze), gaze, min_area, edge_sigma)


def traced_in(
    image: NDArray[np.uint8], gaze: Pose, min_area: int = 20, edge_sigma: float = 0.35
) -> Traced:
    labels = ColorTable().classify(image)
    blobs, runs, extents = find_blobs(labels, np.full(len(COLOR_CLASSES), min_area, np.int32))
    padded = np.pad(labels, 1, constant_values=OUTSIDE)
    view = view_of(CAMERA, gaze)
    points = trace(blobs, extents, padded, view[0], edge_sigma)
    return Traced(blobs.view(Blob), runs, extents, padded, points, view)


def candidate_of(
    sides: NDArray[np.record],
    rims: Sequence[tuple[np.record, float, float]],
    points: Points,
    prior: tuple[float, float],
) -> NDArray[np.record]:
    """A candidate 0.3 m high from two sides and from rims with heights and halves."""
    candidates = np.zeros(1, Candidate)
    candidate = candidates[0]
    candidate.height, candidate.prior = 0.30, prior
    for j in range(2):
        copy_side(candidate.sides[j], sides[j])
    for rim, height, half in rims:
        add_rim(candidate, rim, ANY, points, height, half)
    return candidates


def true_polar(cylinder: Cylinder) -> tuple[float, float]:
    return hypot(cylinder.x, cylinder.y), float(np.arctan2(cylinder.y, cylinder.x))
