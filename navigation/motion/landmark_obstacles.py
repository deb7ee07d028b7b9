"""Known landmarks as what they also are: obstacles that stand."""

from collections.abc import Mapping
from dataclasses import replace
from math import hypot

import numpy as np

from navigation.belief.belief import Belief, Motion, Track
from navigation.parameters.motion import LandmarkParameters


class LandmarkObstacles:
    """Adds the landmarks near the robot to what its planner must avoid.

    They are where the robot's map has them, which is wrong for one that somebody moved, and
    have ids below zero, which no track has.

    Args:
        known: place of every landmark in W by its name [m].
        radius: of a landmark [m].
        parameters: how near one matters, and how sure its place is.
    """

    def __init__(
        self,
        known: Mapping[str, tuple[float, float]],
        radius: float,
        parameters: LandmarkParameters,
    ) -> None:
        self._range = parameters.attention_range
        self._tracks = tuple(
            _standing(number - len(known), name, place, radius, parameters.sigma)
            for number, (name, place) in enumerate(known.items())
        )
        self._places = tuple(known.values())

    def added_to(self, belief: Belief) -> Belief:
        """`belief` with a static track of every landmark near; itself where there is none."""
        here_x, here_y, _ = belief.pose.tolist()
        near = tuple(
            track
            for track, (x, y) in zip(self._tracks, self._places, strict=True)
            if hypot(x - here_x, y - here_y) < self._range
        )
        return replace(belief, tracks=near + belief.tracks) if near else belief


def _standing(
    number: int, name: str, place: tuple[float, float], radius: float, sigma: float
) -> Track:
    position = np.array(place)
    return Track(
        id=number,
        label=name,
        position=position,
        velocity=np.zeros(2),
        covariance=sigma**2 * np.eye(4),
        radius=radius,
        radius_sigma=0.0,
        motion=Motion.STATIC,
        hits=0,
        age=0.0,
        last_seen=position,
        visible=False,
    )
