"""Visibility: field of view, range and occlusion of the camera."""

from math import cos, pi, tan

import numpy as np
from numpy.typing import NDArray

from navigation.belief import visibility_kernel
from navigation.observation import CameraView, Sight
from navigation.transform import yaw_rotation
from navigation.value import value

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@value
class Viewpoint:
    """Camera of one frame in the field frame W.

    Attributes:
        rotation: R_WC, columns right, down, forward (3, 3).
        position: p_WC (3,) [m].
        horizontal_half, vertical_half: half the fields of view [rad]. A horizontal half of pi/2
            or more means a panoramic camera, which also sees up and down.
        range: maximum distance of a detection along the floor, 0 for a blind camera [m].
        heading: of the robot [rad].
        sight: what an image must show of an obstacle.
    """

    rotation: Array
    position: Array
    horizontal_half: float
    vertical_half: float
    range: float
    heading: float = 0.0
    sight: Sight = Sight()

    @classmethod
    def of(cls, view: CameraView, pose: Array, reach: float) -> "Viewpoint":
        """Transform the camera of a frame to W.

        Args:
            view: camera in R.
            pose: x, y, heading of R in W (3,) [m, m, rad].
            reach: range [m].
        """
        x, y, heading = pose.tolist()
        rotation = yaw_rotation(heading)
        position = rotation @ view.position
        position[0] += x
        position[1] += y
        return cls(
            rotation @ view.rotation,
            position,
            0.5 * view.horizontal_fov,
            0.5 * view.vertical_fov,
            0.0 if view.blind else reach,
            heading,
            view.sight,
        )

    def in_clear_view(
        self, points: Array, centres: Array, radii: Array, *, margin: float, occlusion_margin: float
    ) -> Mask:
        """Return whether an obstacle at each point is in clear view: its top or its foot (n,).

        Args:
            points: in W (n, 2) [m].
            centres: of the occluding discs (m, 2) [m].
            radii: of these discs (m,) [m].
            margin: distance from the border of the image [rad].
            occlusion_margin: enlargement of every disc [m].
        """
        return visibility_kernel.in_clear_view(
            points, *self.packed(margin), centres, radii, occlusion_margin
        )

    def observed_cells(
        self, corner: tuple[int, int], cell: float, count: int, centres: Array, radii: Array
    ) -> visibility_kernel.Marks:
        """Return which cells of a grid a frame shows: UNSEEN, FREE or OCCUPIED (count, count).

        Args:
            corner: index of the first column and row, counted from the origin of W.
            cell: side of a cell [m].
            count: cells along a side.
            centres: of the detected discs in W (m, 2) [m].
            radii: (m,) [m].
        """
        first = np.array(corner, np.float64)
        return visibility_kernel.observed_cells(
            first, cell, count, *self.packed(0.0), centres, radii
        )

    def packed(self, margin: float) -> tuple[Array, visibility_kernel.Camera, Array]:
        """Return position, camera less a margin [rad] and shadow, as `in_view` takes them."""
        return self.position, self._camera(margin), self.sight.shadow

    def _camera(self, margin: float) -> visibility_kernel.Camera:
        """Camera in the format of `visibility_kernel.in_view` (15)."""
        panoramic = self.horizontal_half >= 0.5 * pi
        return (
            *self.rotation.ravel().tolist(),
            -float(self.position[2]),
            -1.0 if panoramic else tan(max(self.horizontal_half - margin, 0.0)),
            cos(min(self.horizontal_half, pi))
            if panoramic
            else tan(max(self.vertical_half - margin, 0.0)),
            float(self.range),
            self.sight.top - float(self.position[2]) if self.sight.top > 0.0 else 0.0,
            float(self.heading),
        )
