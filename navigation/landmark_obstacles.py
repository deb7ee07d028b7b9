"""Known landmarks as what they also are: obstacles that stand."""

from collections.abc import Mapping
from dataclasses import replace
from math import hypot

import numpy as np

from navigation.belief import Belief, Motion, Track

REACH = 1.0
"""Distance within which a landmark may be in the way [m].

Farther off no planner heeds what stands, to a few mm/s, but the roll-outs of `mppi`; ours does not
from 0.7 m on.
"""

SIGMA = 0.005
"""Standard deviation of place and velocity, that of a static track known for long [m, m/s]."""


class LandmarkObstacles:
    """Adds the landmarks near the robot to what its planner must avoid.

    They are where the robot's map has them, which is wrong for one that somebody moved, and
    have ids below zero, which no track has.

    Args:
        known: place of every landmark in W by its name [m].
        radius: of a landmark [m].
    """

    def __init__(self, known: Mapping[str, tuple[float, float]], radius: float) -> None:
        self._tracks = tuple(
            _standing(number - len(known), name, place, radius)
            for number, (name, place) in enumerate(known.items())
        )
        self._places = tuple(known.values())

    def added_to(self, belief: Belief) -> Belief:
        """`belief` with a static track of every landmark near; itself where there is none."""
        here_x, here_y, _ = belief.pose.tolist()
        near = tuple(
            track
            for track, (x, y) in zip(self._tracks, self._places, strict=True)
            if hypot(x - here_x, y - here_y) < REACH
        )
        return replace(belief, tracks=near + belief.tracks) if near else belief


def _standing(number: int, name: str, place: tuple[float, float], radius: float) -> Track:
    position = np.array(place)
    return Track(
        id=number,
        label=name,
        position=position,
        velocity=np.zeros(2),
        covariance=SIGMA**2 * np.eye(4),
        radius=radius,
        radius_sigma=0.0,
        motion=Motion.STATIC,
        hits=0,
        age=0.0,
        last_seen=position,
        visible=False,
    )
