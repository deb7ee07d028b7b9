"""What the camera could see: the pinhole view, its range, and what hides what."""

from math import cos, pi, sin, tan

import numpy as np
from numpy.typing import NDArray

from navigation.belief import visibility_kernel
from navigation.observation import CameraView
from navigation.value import value

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@value
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
        camera = self._camera(margin)
        return visibility_kernel.expects(points, self.position, camera, centres, radii, slack)

    def searched(
        self, corner: tuple[int, int], cell: float, count: int, centres: Array, radii: Array
    ) -> visibility_kernel.Marks:
        """What a look shows of the cells of a grid: UNSEEN, FREE or COVERED (count, count).

        Args:
            corner: number of the first column and row from the origin of W.
            cell: side of a cell [m].
            count: cells along a side.
            centres: of the discs in the frame, in W (m, 2) [m].
            radii: (m,) [m].
        """
        camera = self._camera(0.0)
        first = np.array(corner, np.float64)
        return visibility_kernel.searched(first, cell, count, self.position, camera, centres, radii)

    def _camera(self, margin: float) -> visibility_kernel.Camera:
        """Camera as `visibility_kernel.contained` wants it, for the floor (13)."""
        wide = self.horizontal_half >= 0.5 * pi
        return (
            *self.rotation.ravel().tolist(),
            -float(self.position[2]),
            -1.0 if wide else tan(max(self.horizontal_half - margin, 0.0)),
            tan(max(self.vertical_half - margin, 0.0)),
            float(self.range),
        )
