"""What the camera could see: the pinhole view, its range, and what hides what."""

from dataclasses import dataclass
from math import cos, pi, sin, tan

import numpy as np
from numpy.typing import NDArray

from navigation.observation import CameraView

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Viewpoint:
    """The camera of one frame, placed in the field frame W.

    Attributes:
        rotation: R_WC, columns right, down, forward (3, 3).
        position: p_WC (3,) [m].
        horizontal_half, vertical_half: half the fields of view [rad]; with a horizontal one of
            a quarter turn or more the camera is no pinhole but sees all around, up and down.
        range: distance along the floor beyond which nothing is recognised [m].
    """

    rotation: Array
    position: Array
    horizontal_half: float
    vertical_half: float
    range: float

    @classmethod
    def of(cls, view: CameraView, pose: Array, reach: float) -> "Viewpoint":
        """Place the view of a frame in W.

        Args:
            view: camera in R.
            pose: x, y, heading of R in W (3,) [m, m, rad].
            reach: range [m].
        """
        x, y, heading = pose.tolist()
        c, s = cos(heading), sin(heading)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        position = turn @ view.position
        position[0] += x
        position[1] += y
        return cls(
            turn @ view.rotation,
            position,
            0.5 * view.horizontal_fov,
            0.5 * view.vertical_fov,
            reach,
        )

    def contains(self, points: Array, height: float = 0.0, margin: float = 0.0) -> Mask:
        """Whether points project into the image and lie within range.

        Args:
            points: in W (n, 2) [m].
            height: above the floor [m].
            margin: kept from the border of the image [rad].

        Returns:
            One truth value per point (n,).
        """
        return self.contains_grid(points[:, 0], points[:, 1], height, margin)

    def contains_grid(self, x: Array, y: Array, height: float = 0.0, margin: float = 0.0) -> Mask:
        """`contains` for coordinates that broadcast against each other [m]."""
        dx = x - self.position[0]
        dy = y - self.position[1]
        if self.horizontal_half >= 0.5 * pi:
            near: Mask = np.broadcast_to(
                dx * dx + dy * dy <= self.range**2, np.broadcast(x, y).shape
            )
            return near.copy()
        dz = height - float(self.position[2])
        R = self.rotation.tolist()
        forward = (R[0][2] * dx + R[2][2] * dz) + R[1][2] * dy
        right = (R[0][0] * dx + R[2][0] * dz) + R[1][0] * dy
        down = (R[0][1] * dx + R[2][1] * dz) + R[1][1] * dy
        inside: Mask = (
            (forward > 0.0)
            & (np.abs(right) <= tan(max(self.horizontal_half - margin, 0.0)) * forward)
            & (np.abs(down) <= tan(max(self.vertical_half - margin, 0.0)) * forward)
            & (dx * dx + dy * dy <= self.range**2)
        )
        return inside

    def hidden(self, points: Array, centres: Array, radii: Array, slack: float = 0.0) -> Mask:
        """Whether a nearer disc stands between the camera and each point.

        The cylinders are taken as tall enough to hide everything behind them.

        Args:
            points: in W (n, 2) [m].
            centres: of the discs in W (m, 2) [m].
            radii: of the discs (m,) [m].
            slack: widening of every disc [m].

        Returns:
            One truth value per point (n,).
        """
        if len(centres) == 0 or len(points) == 0:
            return np.zeros(len(points), dtype=bool)
        eye = self.position[:2]
        a = centres - eye
        px = points[:, 0, None] - eye[0]
        py = points[:, 1, None] - eye[1]
        ax, ay = a[:, 0], a[:, 1]
        along = px * ax + py * ay
        across = px * ay - py * ax
        # The ray to the point passes the disc's centre at |across| / |p|.
        p2 = px * px + py * py
        reach = (radii + slack) ** 2
        nearer = along > ax * ax + ay * ay
        blocked: Mask = (nearer & (across * across < reach * p2)).any(axis=1)
        return blocked

    def expects(
        self, points: Array, centres: Array, radii: Array, *, margin: float, slack: float
    ) -> Mask:
        """Whether the foot of an obstacle at each point would be seen clearly.

        Args:
            points: in W (n, 2) [m].
            centres: of the discs that may hide them (m, 2) [m].
            radii: of these discs (m,) [m].
            margin: kept from the border of the image [rad].
            slack: widening of every disc [m].

        Returns:
            One truth value per point (n,).
        """
        inside = self.contains(points, margin=margin)
        if inside.any():
            inside[inside] = ~self.hidden(points[inside], centres, radii, slack)
        return inside
