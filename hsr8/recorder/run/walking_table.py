"""Walking table: ZMP, CoM, DCM, feet, velocities and torques in columns, for plots.

The file holds rows: time [s] as a little-endian double, then every other column as a single. Its
header names the columns and holds the constants.

Points are in the world frame W. Points known in the odometry frame are transformed with the true
pose of the robot, so that planned and true curves can be compared.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.record import TickRecord
from hsr8.recorder.files.binary import head, read_rows
from hsr8.recorder.files.writing import GrowingFile
from hsr8.recorder.record_buffer import RecordBuffer
from hsr8.world.truth.truth import Truth
from walking.command_limits import Limit
from walking.phase import Phase
from walking.state import WalkingState

if TYPE_CHECKING:  # reading a table needs no robot
    from walking.body.robot_model import RobotModel

Array = NDArray[np.float64]

MAGIC = b"HSR8WLK3"
PHASES = tuple(Phase)
LIMITS = tuple(Limit)
COLUMNS = (
    "phase",
    "steps",
    *(f"{kind}_{c}" for kind in ("commanded", "applied") for c in ("vx", "vy", "wz")),
    *(f"robot_{c}" for c in ("x", "y", "yaw")),
    *(
        f"{name}_{c}"
        for name in ("zmp", "cop", "com", "measured_com", "dcm", "measured_dcm")
        for c in ("x", "y")
    ),
    *(f"{foot}_{c}" for foot in ("left", "right") for c in ("x", "y", "z", "yaw", "force")),
    "capture_x",
    "capture_y",
    "zmp_depth",
    "roll",
    "pitch",
    "limits",
    *(f"push_{c}" for c in ("x", "y", "z", "fx", "fy", "fz", "begin", "impulse")),
)
"""Columns of every robot; the torques of the leg joints follow."""
LIGHT = 1.0  # feet that carry less have no centre of pressure [N]


@dataclass(frozen=True, slots=True)
class WalkingTable:
    """Walking of a run.

    Attributes:
        time: of each row (n,) [s].
        columns: by name (n,); lengths [m], angles [rad], forces [N], torques [N m].
        sole: centre ahead of the ankle, half length and half width of a sole [m].
        torque_limit: of each leg joint by name, left leg first [N m].
        groups: indices of hip, knee and ankle joints within a leg.
    """

    time: Array
    columns: dict[str, Array]
    sole: tuple[float, float, float]
    torque_limit: dict[str, float]
    groups: dict[str, tuple[int, ...]]

    def __len__(self) -> int:
        return len(self.time)

    def __getitem__(self, name: str) -> Array:
        """Return one column (n,).

        Raises:
            KeyError: unknown column.
        """
        if name not in self.columns:
            raise KeyError(f"no column {name!r}; expected one of {', '.join(self.columns)}")
        return self.columns[name]

    def points(self, name: str) -> Array:
        """Return both coordinates of a point (n, 2) [m], for example ``zmp`` or ``left``.

        Raises:
            KeyError: unknown point.
        """
        return np.column_stack([self[f"{name}_x"], self[f"{name}_y"]])

    def window(self, start: float, stop: float) -> WalkingTable:
        """Return the rows from `start` to `stop` [s]."""
        chosen = (self.time >= start - 1e-9) & (self.time <= stop + 1e-9)
        columns = {name: values[chosen] for name, values in self.columns.items()}
        return replace(self, time=self.time[chosen], columns=columns)

    def active_limits(self) -> dict[Limit, NDArray[np.bool_]]:
        """Return the rows (n,) in which each limit was active, without limits that never were."""
        mask = self["limits"].astype(np.int64)
        active = {limit: (mask >> k) & 1 == 1 for k, limit in enumerate(LIMITS)}
        return {limit: rows for limit, rows in active.items() if rows.any()}


class WalkingTableWriter:
    """Writer of the walking table of a run.

    Args:
        path: file to create.
        robot: that walks.

    Raises:
        RecordingFailed: here and in every method, it cannot be written.
    """

    def __init__(self, path: Path, robot: RobotModel) -> None:
        names, sole = robot.names[:12], robot.sole
        self._columns = (*COLUMNS, *(f"torque_{name}" for name in names))
        header = {
            "columns": self._columns,
            "sole": [sole.centre, sole.half_length, sole.half_width],
            "joints": names,
            "torque_limit": robot.tree.effort[:12].tolist(),
            "groups": robot.leg_groups(),
        }
        self._buffer = RecordBuffer()
        self._file = GrowingFile(path, head(MAGIC, header))

    def on_record(self, record: TickRecord) -> None:
        """Append one row."""
        if self._buffer.add(record):
            self._write_buffer()
            self._file.flush()

    def on_event(self, time: float, kind: str, text: str) -> None:
        """Ignore events."""

    def close(self, exit_reason: str) -> None:
        """Write the remaining rows and close the file."""
        try:
            self._write_buffer()
        finally:
            self._file.close()

    def _write_buffer(self) -> None:
        records = self._buffer.take()
        table = np.empty(len(records), dtype=_row_type(len(self._columns)))
        table["time"] = [record.time for record in records]
        if records:
            table["values"] = _values(records)
        self._file.write(table.tobytes())


def read_walking_table(path: Path) -> WalkingTable:
    """Read a walking table, also that of a killed run.

    Raises:
        UsageError: the file is missing, damaged or not a walking table.
    """
    header, content = read_rows(path, MAGIC, "walking table")
    try:
        centre, half_length, half_width = map(float, header["sole"])
        limits = dict(zip(header["joints"], map(float, header["torque_limit"]), strict=True))
        groups = {name: tuple(map(int, joints)) for name, joints in header["groups"].items()}
        columns = (*COLUMNS, *(f"torque_{name}" for name in limits))
        indices = {joint for joints in groups.values() for joint in joints}
        complete = tuple(header["columns"]) == columns and indices <= set(range(len(limits) // 2))
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise UsageError(f"{path}: incomplete header") from error
    if not complete:
        raise UsageError(f"{path}: incomplete header")
    row = _row_type(len(columns))
    table = np.frombuffer(content, dtype=row, count=len(content) // row.itemsize)
    time, values = table["time"].astype(np.float64), table["values"].astype(np.float64)
    is_phase = np.isin(values[:, COLUMNS.index("phase")], range(len(PHASES)))
    whole = is_phase & np.isfinite(time) & ~np.isinf(values).any(axis=1)
    if not whole.all():
        raise UsageError(f"{path}: damaged in row {int(np.argmin(whole))}")
    return WalkingTable(
        time=time,
        columns={name: values[:, k] for k, name in enumerate(columns)},
        sole=(centre, half_length, half_width),
        torque_limit=limits,
        groups=groups,
    )


class OdometryToWorld:
    """Transformation from the odometry frame to W by the true pose of the robot.

    Args:
        records: n records.

    Attributes:
        turn: rotation from the odometry frame to W at each record (n,) [rad].
    """

    def __init__(self, records: Sequence[TickRecord]) -> None:
        odometry = [record.walking.odometry for record in records]
        x, y, yaw = np.reshape([(here.x, here.y, here.yaw) for here in odometry], (-1, 3)).T
        true_x, true_y, true_yaw = np.reshape([r.truth.robot for r in records], (-1, 3)).T
        self.turn: Array = true_yaw - yaw
        self._c, self._s = np.cos(self.turn), np.sin(self.turn)
        self._x = true_x - self._c * x + self._s * y
        self._y = true_y - self._s * x - self._c * y

    def point(self, points: Array, rows: NDArray[np.intp] | slice = slice(None)) -> Array:
        """Transform points (n, ..., 2), one per record or of the records in `rows` [m]."""
        x, y = points.T
        c, s = self._c[rows], self._s[rows]
        return np.array((self._x[rows] + c * x - s * y, self._y[rows] + s * x + c * y)).T

    def vector(self, vectors: Array) -> Array:
        """Rotate vectors (n, ..., 2)."""
        x, y = vectors.T
        return np.array([self._c * x - self._s * y, self._s * x + self._c * y]).T


def _values(records: Sequence[TickRecord]) -> Array:
    """Return all columns except the time (n, columns)."""
    truths, walks = [r.truth for r in records], [r.walking for r in records]
    balances = [walking.balance for walking in walks]
    transform = OdometryToWorld(records)
    force = np.array([truth.foot_force for truth in truths])
    loaded = force.sum(axis=1, keepdims=True) > LIGHT
    feet = np.array([balance.feet for balance in balances])
    feet[..., :2], feet[..., 3] = (
        transform.point(feet[..., :2]),
        feet[..., 3] + transform.turn[:, None],
    )
    points = [(b.com, w.com, w.dcm, b.dcm) for w, b in zip(walks, balances, strict=True)]
    return np.column_stack(
        [
            [(PHASES.index(walking.phase), walking.step_count) for walking in walks],
            [record.command.velocity for record in records],
            [walking.applied_velocity for walking in walks],
            [truth.robot for truth in truths],
            transform.point(np.array([walking.zmp for walking in walks])),
            np.where(loaded, [truth.zmp for truth in truths], np.nan),
            transform.point(np.array(points)).reshape(len(records), -1),
            np.dstack([feet, force]).reshape(len(records), -1),
            transform.vector(np.array([balance.capture for balance in balances])),
            [(w.balance.zmp_depth, w.roll, w.pitch) for w in walks],
            [_limit_bits(walking) for walking in walks],
            [_push(truth) for truth in truths],
            np.array([truth.joint_torque for truth in truths])[:, :12],
        ]
    )


def _limit_bits(walking: WalkingState) -> int:
    """Return the active limits of the command, one bit each."""
    limits = walking.command_limits.limits if walking.command_limits is not None else ()
    return sum({1 << LIMITS.index(limit) for limit in limits})


def _push(truth: Truth) -> tuple[float, ...]:
    if not truth.pushes:
        return (0.0,) * 8
    push = truth.pushes[0]
    return (*push.point.tolist(), *push.force.tolist(), push.begin, push.impulse)


def _row_type(columns: int) -> np.dtype[np.void]:
    return np.dtype([("time", "<f8"), ("values", "<f4", (columns,))])
