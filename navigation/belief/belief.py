"""What the robot believes: its pose, the obstacles, and how fresh its map is."""

from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from navigation.value import value

if TYPE_CHECKING:
    from navigation.belief.local_map import LocalMap
    from navigation.observation import CameraView

Array = NDArray[np.float64]


class Motion(StrEnum):
    """Statistical verdict on whether an obstacle moves."""

    STATIC = "static"
    MOVING = "moving"
    UNKNOWN = "unknown"


@value
class Particles:
    """Hypotheses where an unseen mover may be.

    Attributes:
        positions: in W (n, 2) [m].
        velocities: in W (n, 2) [m/s].
        turn_rates: of the velocities, left positive (n,) [rad/s].
        weights: sum to one (n,).
    """

    positions: Array
    velocities: Array
    turn_rates: Array
    weights: Array


@value
class Track:
    """One obstacle as the robot believes it to be, in the field frame W.

    Attributes:
        id: number, unique in a run.
        label: colour class.
        position: (2,) [m].
        velocity: (2,) [m/s]; zero for a static track.
        covariance: of (x, y, vx, vy) (4, 4).
        radius: [m].
        radius_sigma: [m].
        motion: static, moving or not yet known.
        hits: number of detections.
        age: time from its last detection to the capture of the frame [s].
        last_seen: where it was detected last (2,) [m].
        visible: detected in the latest frame.
        particles: hypotheses of a lost track that may move, else None.
        reach: radius of the disc about `last_seen` that its axis cannot have left by the time of
            the frame: three standard deviations of that sighting and, unless it stands still,
            the way of the fastest obstacle since [m].
        turn_rate: of the velocity, left positive; zero for a static track [rad/s].
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
    """Everything the robot believes after a camera frame.

    Attributes:
        time: of pose and positions [s]: of the capture, or later once it was carried on by
            `navigation.belief.prediction`.
        pose: x, y, heading of R in W (3,) [m, m, rad], heading wrapped.
        pose_covariance: (3, 3).
        tracks: obstacles, by id.
        local_map: occupancy, confidence and age per cell around the robot.
        view: where the camera looked, angles in R.
        seen_beacons: names of beacons in this frame.
        lost: whether localization has noticed that it is lost.
        filter_faults: how often a filter had to be re-initialised so far.
    """

    time: float
    pose: Array
    pose_covariance: Array
    tracks: tuple[Track, ...]
    local_map: "LocalMap"
    view: "CameraView"
    seen_beacons: tuple[str, ...]
    lost: bool
    filter_faults: int
