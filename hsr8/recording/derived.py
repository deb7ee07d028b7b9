"""Quantities derived from the tables of a run: world frame, strides, pushes, truth, ellipses."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from hsr8.recording.table import Table
from navigation.angles import wrap
from walking.body.robot_model import RobotModel
from walking.state import Phase

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

LIGHT = 1.0  # feet that carry less have no centre of pressure [N]
STRAIGHT = 1e-9  # half turn below which the arc is a straight line [rad]
STRIDE = 2  # footsteps after which the gait repeats
IDLE = 1.0  # interval that takes the place of a stride without footsteps [s]


class WorldFrame:
    """Transformation from the odometry frame to W by the true pose of the robot.

    Planned and true curves can be compared in W.

    Args:
        records: n rows of the table of records.

    Attributes:
        turn: rotation from the odometry frame to W at each row (n,) [rad].
    """

    def __init__(self, records: Table) -> None:
        x, y, yaw = records["odometry"].T
        true_x, true_y, true_yaw = records["robot"].T
        self.turn: Array = true_yaw - yaw
        self._c, self._s = np.cos(self.turn), np.sin(self.turn)
        self._x = true_x - self._c * x + self._s * y
        self._y = true_y - self._s * x - self._c * y

    def point(self, points: Array, rows: Rows | slice = slice(None)) -> Array:
        """Transform points (n, ..., 2), one per row or of the given `rows` [m]."""
        x, y = points.T
        c, s = self._c[rows], self._s[rows]
        return np.array((self._x[rows] + c * x - s * y, self._y[rows] + s * x + c * y)).T

    def vector(self, vectors: Array) -> Array:
        """Rotate vectors (n, ..., 2)."""
        x, y = vectors.T
        return np.array([self._c * x - self._s * y, self._s * x + self._c * y]).T


@dataclass(frozen=True, slots=True)
class Walk:
    """Walking in W; n rows of the table of records.

    Attributes:
        records: the rows.
        model: model of the robot.
        time: simulated time (n,) [s].
        zmp: planned zero-moment point (n, 2) [m].
        cop: true centre of pressure, NaN where the feet carry nothing (n, 2) [m].
        com: planned centre of mass (n, 2) [m].
        measured_com: measured centre of mass (n, 2) [m].
        dcm: planned divergent component of motion (n, 2) [m].
        measured_dcm: measured divergent component of motion (n, 2) [m].
        feet: references of the left and right foot: x, y, height, yaw (n, 2, 4) [m, rad].
        pose: true poses with unwrapped heading (n, 3) [m, m, rad].
    """

    records: Table
    model: RobotModel
    time: Array
    zmp: Array
    cop: Array
    com: Array
    measured_com: Array
    dcm: Array
    measured_dcm: Array
    feet: Array
    pose: Array

    def __len__(self) -> int:
        return len(self.time)


def walk_of(records: Table, model: RobotModel) -> Walk:
    """Return the walking of a run or of a part of it.

    Args:
        records: rows of the table of records.
        model: model of the robot.
    """
    frame = WorldFrame(records)
    feet, pose = records["feet"].copy(), records["robot"].copy()
    feet[..., :2], feet[..., 3] = frame.point(feet[..., :2]), feet[..., 3] + frame.turn[:, None]
    pose[:, 2] = np.unwrap(pose[:, 2])
    names = ("zmp", "com", "measured_com", "dcm", "measured_dcm")
    return Walk(
        records=records,
        model=model,
        time=records["time"],
        cop=loaded_cop(records),
        feet=feet,
        pose=pose,
        **{name: frame.point(records[name]) for name in names},
    )


def loaded_cop(records: Table) -> Array:
    """Return the true centre of pressure in W, NaN where the feet carry nothing (n, 2) [m]."""
    loaded = records["foot_load"].sum(axis=1, keepdims=True) > LIGHT
    cop: Array = np.where(loaded, records["cop"], np.nan)
    return cop


def truth_at(frames: Table, records: Table) -> dict[str, Array]:
    """Return the columns of the true motion in the record of each frame."""
    rows = np.searchsorted(records["time"], frames["time"] - 1e-9)
    columns = ("time", "robot", "obstacle_positions", "obstacle_velocities")
    return {name: records[name][rows] for name in columns}


def ellipse_axes(covariance: Array) -> tuple[Array, Array]:
    """Return the ellipses of one standard deviation.

    Args:
        covariance: (n, 2, 2) [m²].

    Returns:
        Half axes, the longer first (n, 2) [m], and the direction of the longer (n,) [rad].
    """
    xx, xy, yy = covariance[:, 0, 0], covariance[:, 0, 1], covariance[:, 1, 1]
    middle, half = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    direction: Array = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    squares = np.stack([middle + half, middle - half], axis=1)
    return np.sqrt(np.maximum(squares, 0.0)), direction


@dataclass(frozen=True, slots=True)
class Push:
    """Push of the robot.

    Attributes:
        row: first row of the records in which it acts.
        begin: start [s].
        impulse: product of force and duration [N s].
        point: point of the force in W at this row (3,) [m].
        force: force in W at this row (3,) [N].
    """

    row: int
    begin: float
    impulse: float
    point: Array
    force: Array


def pushes_of(records: Table) -> tuple[Push, ...]:
    """Return the pushes in the order of their numbers."""
    acting = records["pushes"]
    firsts = np.unique(acting["number"], return_index=True)[1]
    return tuple(
        Push(
            row=int(acting.parents[k]),
            begin=float(acting["begin"][k]),
            impulse=float(np.linalg.norm(acting["force"][k]) * acting["duration"][k]),
            point=acting["point"][k],
            force=acting["force"][k],
        )
        for k in firsts.tolist()
    )


def mean_velocity(start: Array, end: Array, time: float) -> Array:
    """Return the constant velocity in the robot frame (3,) between two poses (3,) in `time` [s].

    The path is an arc; the headings must be unwrapped.
    """
    dx, dy, turn = (end - start).tolist()
    half = 0.5 * turn
    # The chord deviates from the heading by half the turn and is shorter than the arc.
    arc = half / sin(half) if STRAIGHT < abs(half) < pi else 1.0
    c, s = cos(start[2] + half), sin(start[2] + half)
    return np.array([arc * (c * dx + s * dy), arc * (c * dy - s * dx), turn]) / time


def strides(records: Table, down: NDArray[np.bool_], since: float) -> list[tuple[int, int]]:
    """Return first and last row of every whole stride on the feet.

    Without footsteps, intervals of one second take the place of strides.

    Args:
        records: table of records.
        down: whether the robot lies or gets up (n,).
        since: time from which strides count [s].
    """
    time, steps = records["time"].tolist(), records["step_count"].tolist()
    standing = (records["phase"] == Phase.STANDING.value).tolist()
    whole: list[tuple[int, int]] = []
    begin: int | None = None
    before = 0
    for row, fallen in enumerate(down.tolist()):
        if fallen:
            begin = None
        elif time[row] < since:
            before = steps[row]
        elif begin is None:
            if steps[row] != before or standing[row]:
                begin, before = row, steps[row]
        else:
            still = standing[row] and time[row] - time[begin] >= IDLE and steps[row] == before
            if still or steps[row] - before >= STRIDE:
                whole.append((begin, row))
                begin, before = row, steps[row]
    return whole


class Speedometer:
    """Mean velocity over the latest stride at every footstep, row by row."""

    def __init__(self) -> None:
        self._marks: deque[tuple[float, Array]] = deque(maxlen=STRIDE + 1)
        self._steps = 0
        self._yaw = 0.0

    def add(self, records: Table) -> Iterator[tuple[float, Array]]:
        """Yield middle [s] and mean velocity (3,) [m/s, m/s, rad/s] of strides that end."""
        columns = (records["time"], records["robot"], records["step_count"])
        for time, (x, y, yaw), steps in zip(*(c.tolist() for c in columns), strict=True):
            self._yaw += wrap(yaw - self._yaw)
            idle = not self._marks or time - self._marks[-1][0] >= IDLE - 1e-9
            if steps == self._steps and not idle:
                continue
            self._steps = steps
            pose = np.array([x, y, self._yaw])
            self._marks.append((time, pose))
            mark = max(0, len(self._marks) - 2) if idle else 0
            first, start = self._marks[mark]
            elapsed = time - first
            if elapsed > 0.0:
                yield first + 0.5 * elapsed, mean_velocity(start, pose, elapsed)
