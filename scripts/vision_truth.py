"""Ground truth of a camera image: visible targets, their visible fractions and the pose."""

from dataclasses import dataclass
from math import atan2, hypot

from vision.camera import PinholeCamera

import cv2
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MIN_PIXELS = 12  # a target of which less can be seen does not count [pixel]


@dataclass(frozen=True)
class Target:
    """A cylinder of the scene and how much of it can be seen."""

    kind: str
    label: str
    x: float
    y: float
    radius: float
    height: float
    geoms: tuple[int, ...]


@dataclass(frozen=True)
class Sight:
    """A target in one frame.

    Attributes:
        target: the object.
        distance: distance from the robot [m].
        bearing: [rad].
        hidden: fraction of its outline that other targets hide.
        cut: the border of the image cuts it.
    """

    target: Target
    distance: float
    bearing: float
    hidden: float
    cut: bool

    @property
    def clear(self) -> bool:
        """Whether nothing hides or cuts it."""
        return self.hidden < 0.04 and not self.cut

    @property
    def counted(self) -> bool:
        """Whether the detector is asked to find it."""
        if self.target.kind == "beacon":
            return self.clear and self.distance < 5.0
        return 0.3 <= self.distance <= 2.5


def silhouette(target: Target, camera: PinholeCamera, R: Array, p: Array) -> tuple[Array, bool]:
    """Mask of the whole cylinder as if alone, and whether the border cuts it."""
    angle = np.arange(48) * (2.0 * np.pi / 48)
    ring = np.stack(
        [target.x + target.radius * np.cos(angle), target.y + target.radius * np.sin(angle)]
    )
    points = np.concatenate(
        [np.stack([*ring, np.full(48, z)], axis=1) for z in (0.0, target.height)]
    )
    local = (points - p) @ R
    mask = np.zeros((camera.height, camera.width), np.uint8)
    if (local[:, 2] < 0.02).any():
        return mask, True
    pixels = camera.project(local)
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    cut = bool((low < 0).any() or high[0] > camera.width or high[1] > camera.height)
    hull = cv2.convexHull(pixels.astype(np.float32))[:, 0].astype(float)
    x0, y0 = np.maximum(np.floor(low), 0).astype(int).tolist()
    x1, y1 = np.minimum(np.ceil(high), (camera.width, camera.height)).astype(int).tolist()
    if x1 <= x0 or y1 <= y0:
        return mask, True
    u, v = np.meshgrid(np.arange(x0, x1) + 0.5, np.arange(y0, y1) + 0.5)
    edge = np.roll(hull, -1, axis=0) - hull
    side = edge[:, 0, None, None] * (v - hull[:, 1, None, None]) - edge[:, 1, None, None] * (
        u - hull[:, 0, None, None]
    )
    mask[y0:y1, x0:x1] = (side >= 0).all(axis=0) | (side <= 0).all(axis=0)
    return mask, cut


def sights(
    geoms: NDArray[np.int32], R: Array, p: Array, targets: list[Target], camera: PinholeCamera
) -> list[Sight]:
    """Targets of which at least a few pixels can be seen, nearest first."""
    sights = []
    for target in targets:
        pixels = int(np.isin(geoms, target.geoms).sum())
        if pixels < MIN_PIXELS:
            continue
        full, cut = silhouette(target, camera, R, p)
        hidden = 1.0 - pixels / max(int(full.sum()), 1)
        distance, bearing = hypot(target.x, target.y), atan2(target.y, target.x)
        sights.append(Sight(target, distance, bearing, hidden, cut))
    return sorted(sights, key=lambda s: s.distance)
