"""Observations: the belief of the robot in its own frame, as arrays of fixed size."""

from collections.abc import Iterable, Sequence
from math import cos, pi, sin
from typing import Any, cast

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.suggestion import suggestion
from navigation.angles import wrap
from navigation.belief.belief import Belief, Motion, Track
from navigation.decision import Task

Array = NDArray[np.float64]
Observation = dict[str, NDArray[Any]]

OPTIONAL = ("local_map", "image")
MAX_TRACKS = 16
MAP_CELLS = 48  # along each side of the local map
MOVING = {Motion.STATIC: 0.0, Motion.UNKNOWN: 0.5, Motion.MOVING: 1.0}
LENGTH, SPEED, TURN_RATE, AGE = 20.0, 5.0, 10.0, 60.0  # bounds [m], [m/s], [rad/s], [s]
BOUNDS = {
    "head": ((-pi, pi), (-pi, pi)),
    "pose_std": ((0.0, LENGTH), (0.0, LENGTH), (0.0, pi)),
    "target": ((-LENGTH, LENGTH), (-LENGTH, LENGTH), (-pi, pi)),
    "velocity": ((-SPEED, SPEED), (-SPEED, SPEED), (-TURN_RATE, TURN_RATE)),
}
TRACK_BOUNDS = (
    *((-LENGTH, LENGTH), (-LENGTH, LENGTH), (-SPEED, SPEED), (-SPEED, SPEED)),
    *((0.0, LENGTH), (0.0, LENGTH), (0.0, AGE), (0.0, 1.0), (0.0, 1.0)),
)
"""Of x, y, vx, vy in R, standard deviation of the position, radius, age, moving, visible."""


class Observer:
    """Observations of one run, in order.

    Args:
        observe: optional parts, of `OPTIONAL`.
        max_tracks: number of observed tracks, the nearest first.

    Attributes:
        velocity: latest motion decision (3,) [m/s, m/s, rad/s].

    Raises:
        UsageError: an optional part is unknown, or `max_tracks` is not positive.
    """

    def __init__(self, observe: Sequence[str] = (), max_tracks: int = MAX_TRACKS) -> None:
        require_names("observe", observe, OPTIONAL)
        if max_tracks < 1:
            raise UsageError(f"max_tracks: out of range, got {max_tracks}; expected at least 1")
        self._parts = set(observe)
        self._max_tracks = max_tracks
        self._track_bounds = np.array(TRACK_BOUNDS).T
        self._bounds = {key: np.array(bounds).T for key, bounds in BOUNDS.items()}
        self._cells = np.mgrid[0:MAP_CELLS, 0:MAP_CELLS].reshape(2, -1) - 0.5 * (MAP_CELLS - 1)
        self.velocity = np.zeros(3)

    def space(self, width: int, height: int) -> spaces.Space[Observation]:
        """Return the space of the observations; `width` and `height` of images [pixel]."""
        boxes: dict[str, spaces.Space[Any]] = {
            key: spaces.Box(*bounds.astype(np.float32)) for key, bounds in self._bounds.items()
        }
        low, high = self._track_bounds.astype(np.float32)
        tracks = (self._max_tracks, len(TRACK_BOUNDS))
        boxes["tracks"] = spaces.Box(np.broadcast_to(low, tracks), np.broadcast_to(high, tracks))
        boxes["track_mask"] = spaces.MultiBinary(self._max_tracks)
        if "local_map" in self._parts:
            boxes["local_map"] = spaces.Box(0, 255, (MAP_CELLS, MAP_CELLS, 1), np.uint8)
        if "image" in self._parts:
            boxes["image"] = spaces.Box(0, 255, (height, width, 3), np.uint8)
        return cast("spaces.Space[Observation]", spaces.Dict(boxes))

    def observe(
        self, belief: Belief, task: Task, image: NDArray[np.uint8] | None = None
    ) -> Observation:
        """Return the observation of a situation, in new arrays.

        Args:
            belief: belief of the robot; tracks with negative ids, known beacons, are left out.
            task: task of the mission.
            image: image of the head camera.
        """
        x, y, heading = belief.pose.tolist()
        to_R = np.array([[cos(heading), sin(heading)], [-sin(heading), cos(heading)]])
        target_x, target_y = (to_R @ (task.target - (x, y))).tolist()
        values: dict[str, Array] = {
            "head": np.array([belief.view.pan, belief.view.tilt]),
            "pose_std": np.sqrt(np.diagonal(belief.pose_covariance)),
            "target": np.array([target_x, target_y, wrap(task.heading - heading)]),
            "velocity": self.velocity,
        }
        tracks = [track for track in belief.tracks if track.id >= 0]
        rows, mask = self._rows(tracks, np.array([x, y]), to_R)
        observation: Observation = {
            key: np.clip(value, *self._bounds[key]).astype(np.float32)
            for key, value in values.items()
        }
        observation["tracks"] = np.clip(rows, *self._track_bounds).astype(np.float32)
        observation["track_mask"] = mask
        if "local_map" in self._parts:
            points = (x, y) + belief.local_map.cell * (self._cells.T @ to_R)
            shades = np.round(255.0 * belief.local_map.confidence_at(points)).astype(np.uint8)
            observation["local_map"] = shades.reshape(MAP_CELLS, MAP_CELLS, 1)
        if "image" in self._parts and image is not None:
            observation["image"] = image.copy()
        return observation

    def _rows(
        self, tracks: Sequence[Track], position: Array, to_R: Array
    ) -> tuple[Array, NDArray[np.int8]]:
        """Return the nearest tracks (n, 9), and which rows are in use (n,)."""
        rows = np.zeros((self._max_tracks, len(TRACK_BOUNDS)))
        mask = np.zeros(len(rows), np.int8)
        if tracks:
            offsets = np.array([track.position for track in tracks]) - position
            nearest = np.argsort(np.hypot(*offsets.T), kind="stable")[: len(rows)]
            chosen = [tracks[i] for i in nearest.tolist()]
            used = rows[: len(chosen)]
            mask[: len(chosen)] = 1
            used[:, :2] = offsets[nearest] @ to_R.T
            used[:, 2:4] = np.array([track.velocity for track in chosen]) @ to_R.T
            used[:, 4:] = [
                (
                    (0.5 * (t.covariance[0, 0] + t.covariance[1, 1])) ** 0.5,
                    t.radius,
                    t.age,
                    MOVING[t.motion],
                    t.visible,
                )
                for t in chosen
            ]
        return rows, mask


def require_names(option: str, names: Iterable[str], known: Iterable[str]) -> None:
    """Require known names.

    Raises:
        UsageError: one is unknown.
    """
    choices = tuple(known)
    for name in names:
        if name not in choices:
            raise UsageError(
                f"{option}: unknown name, got {name!r}; expected {', '.join(choices)}"
                f"{suggestion(str(name), choices)}"
            )
