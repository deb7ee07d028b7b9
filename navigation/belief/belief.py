"""Belief of the robot: its pose, obstacle tracks and local map."""

from collections.abc import Sequence
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from compilation.value import value

if TYPE_CHECKING:
    from navigation.belief.local_map import LocalMap
    from navigation.observation import CameraView

Array = NDArray[np.float64]


class Motion(StrEnum):
    """Motion class of an obstacle."""

    STATIC = "static"
    MOVING = "moving"
    UNKNOWN = "unknown"


@value
class Particles:
    """Particle set of a lost mover.

    Attributes:
        positions: positions in W (n, 2) [m].
        velocities: velocities in W (n, 2) [m/s].
        turn_rates: left positive (n,) [rad/s].
        weights: sum to one (n,).
    """

    positions: Array
    velocities: Array
    turn_rates: Array
    weights: Array


@value
class Track:
    """Estimate of one obstacle in the field frame W.

    Attributes:
        id: number, unique in a run.
        label: colour class.
        position: (2,) [m].
        velocity: (2,) [m/s]; zero for a static track.
        covariance: covariance of (x, y, vx, vy) (4, 4).
        radius: [m].
        radius_sigma: [m].
        motion: motion class.
        hits: number of detections.
        age: time from its last detection to the capture of the frame [s].
        last_seen: position of its last detection (2,) [m].
        visible: detected in the latest frame.
        particles: particles of a lost track that may move, else None.
        reach: radius of the reachable disc of its axis around `last_seen`: three standard
            deviations of that detection plus, unless static, max_speed times age [m].
        turn_rate: left positive; zero for a static track [rad/s].
    """

    id: int
    label: str
    position: Array
    velocity: Array
    covariance: Array
    radius: float
    radius_sigma: float
    motion: Motion
    hits: int
    age: float
    last_seen: Array
    visible: bool
    particles: Particles | None = None
    reach: float = 0.0
    turn_rate: float = 0.0


@value
class Belief:
    """Pose, tracks and local map after a camera frame.

    Attributes:
        time: time of pose and positions [s]: that of the capture, or later after
            `navigation.belief.estimator`.
        pose: x, y, heading of R in W (3,) [m, m, rad], heading wrapped.
        pose_covariance: (3, 3).
        tracks: obstacles, by id; see `navigation.belief.tracks` for arrays.
        local_map: occupancy, confidence and age per cell around the robot.
        view: pose and field of view of the camera in R.
        seen_beacons: names of the beacons in the frame.
        lost: whether localization has detected that it is lost.
        filter_faults: number of re-initializations of the filter.
    """

    time: float
    pose: Array
    pose_covariance: Array
    tracks: Sequence[Track]
    local_map: "LocalMap"
    view: "CameraView"
    seen_beacons: tuple[str, ...]
    lost: bool
    filter_faults: int
