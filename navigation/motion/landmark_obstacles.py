"""Known landmarks as static obstacles."""

from collections.abc import Mapping
from dataclasses import replace
from math import hypot

import numpy as np

from navigation.belief.belief import Belief, Motion, Track
from navigation.belief.tracks import join
from navigation.parameters.motion import LandmarkParameters


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
        self._tracks = tuple(
            _static_track(number - len(known), name, position, radius, parameters)
            for number, (name, position) in enumerate(known.items())
        )

    def added_to(self, belief: Belief) -> Belief:
        """Return `belief` with a static track of every landmark in range."""
        near = tuple(
            track
            for track in self._tracks
            if hypot(*(track.position - belief.pose[:2]).tolist()) < self._range
        )
        return replace(belief, tracks=join(near, belief.tracks)) if near else belief


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
