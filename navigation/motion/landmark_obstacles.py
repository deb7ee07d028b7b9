"""Known landmarks as static obstacles."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from navigation.belief.belief import Motion, Track
from navigation.belief.tracks import Tracks
from navigation.parameters.motion import LandmarkParameters

Array = NDArray[np.float64]


class LandmarkObstacles:
    """Landmarks near the robot as static tracks of the belief.

    Their positions are those of the robot's map; their ids are negative.

    Args:
        known: position of every landmark in W by its name [m].
        radius: radius of a landmark [m].
        parameters: attention range and standard deviation.
    """

    def __init__(
        self,
        known: Mapping[str, tuple[float, float]],
        radius: float,
        parameters: LandmarkParameters,
    ) -> None:
        self._range = parameters.attention_range
        self._tracks = Tracks.of(
            [
                _static_track(number - len(known), name, position, radius, parameters)
                for number, (name, position) in enumerate(known.items())
            ]
        )

    def near(self, position: Array) -> Tracks:
        """Return a static track of every landmark in range of `position` in W (2,) [m]."""
        offset = self._tracks.position - position
        return self._tracks.where(np.hypot(offset[:, 0], offset[:, 1]) < self._range)


def _static_track(
    number: int, name: str, position: tuple[float, float], radius: float, p: LandmarkParameters
) -> Track:
    return Track(
        id=number,
        label=name,
        position=np.array(position),
        velocity=np.zeros(2),
        covariance=np.diag(np.square([p.sigma, p.sigma, p.velocity_sigma, p.velocity_sigma])),
        radius=radius,
        radius_sigma=0.0,
        motion=Motion.STATIC,
        hits=0,
        age=0.0,
        last_seen=np.array(position),
        visible=False,
    )
