"""How a run walked, in columns: what plots are drawn from afterwards.

A file of rows: time [s] as a little-endian double, then every other column as a single. Its
header names the columns and holds what does not change.

Points are in W. What the robot knows in its odometry frame is put there by its true pose of
the moment, so that planned and true curves can be compared.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, sin
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.block import Block
from hsr8.recorder.headed_file import HeadedWriter, read_headed
from hsr8.recorder.record import Listener, TickRecord
from hsr8.world.index import ModelIndex
from walking.admission import Limit
from walking.joints import JOINT_NAMES
from walking.state import Phase

Array = NDArray[np.float64]

MAGIC = b"HSR8WLK1"
LEG_JOINTS = JOINT_NAMES[:12]
PHASES = tuple(Phase)
LIMITS = tuple(Limit)
COLUMNS = (
    "phase",
    "steps",
    *(f"{kind}_{c}" for kind in ("asked", "given") for c in ("vx", "vy", "wz")),
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
    *(f"torque_{name}" for name in LEG_JOINTS),
)
LIGHT = 1.0  # no centre of pressure is told under feet that carry less [N]


@dataclass(frozen=True, slots=True)
class WalkingTable:
    """How a run walked.

    Attributes:
        time: of each row (n,) [s].
        columns: by name (n,); lengths [m], angles [rad], forces [N], torques [N m].
        sole: middle ahead of the ankle, half length and half width of a sole [m].
        torque_limit: of each leg joint [N m].
    """

    time: Array
    columns: dict[str, Array]
    sole: tuple[float, float, float]
    torque_limit: dict[str, float]

    def __len__(self) -> int:
        return len(self.time)

    def __getitem__(self, name: str) -> Array:
        """One column (n,).

        Raises:
            KeyError: there is no such column.
        """
        if name not in self.columns:
            raise KeyError(f"there is no column {name!r}, but {', '.join(self.columns)}")
        return self.columns[name]

    def points(self, name: str) -> Array:
        """Both coordinates of a point (n, 2) [m], for example of ``zmp`` or ``left``.

        Raises:
            KeyError: there is no such point.
        """
        return np.column_stack([self[f"{name}_x"], self[f"{name}_y"]])

    def window(self, start: float, stop: float) -> "WalkingTable":
        """The rows from `start` to `stop` [s]."""
        chosen = (self.time >= start - 1e-9) & (self.time <= stop + 1e-9)
        columns = {name: values[chosen] for name, values in self.columns.items()}
        return WalkingTable(self.time[chosen], columns, self.sole, self.torque_limit)

    def bound(self) -> dict[Limit, NDArray[np.bool_]]:
        """Where each constraint altered the command (n,); those that never did are left out."""
        mask = self["limits"].astype(np.int64)
        found = {limit: (mask >> k) & 1 == 1 for k, limit in enumerate(LIMITS)}
        return {limit: rows for limit, rows in found.items() if rows.any()}


class WalkingTableWriter(Listener):
    """Listener that writes the table of a run.

    Args:
        path: file to create, or to go on with.
        model: compiled world.
        index: addresses in it.

    Raises:
        RecordingFailed: here and in every method, it cannot be written.
    """

    def __init__(self, path: Path, model: mujoco.MjModel, index: ModelIndex) -> None:
        sole = index.foot_geoms[0]
        header = {
            "columns": COLUMNS,
            "sole": [float(v) for v in (model.geom_pos[sole][0], *model.geom_size[sole][:2])],
            "torque_limit": model.actuator_forcerange[index.actuators[:12], 1].tolist(),
        }
        self._waiting = Block()
        self._file = HeadedWriter(path, MAGIC, header)

    def on_record(self, record: TickRecord) -> None:
        """Append one row."""
        if self._waiting.add(record):
            self.flush()

    def flush(self) -> None:
        """Hand everything to the operating system."""
        self._work_off()
        self._file.flush()

    def close(self, exit_reason: str) -> None:
        """Finish the file."""
        try:
            self._work_off()
        finally:
            self._file.close()

    def _work_off(self) -> None:
        """Write the rows of the records that wait."""
        records = self._waiting.take()
        table = np.empty(len(records), dtype=_row_type(len(COLUMNS)))
        table["time"] = [record.time for record in records]
        table["values"] = np.reshape([_row(record) for record in records], (-1, len(COLUMNS)))
        self._file.write(table.tobytes())


def read_walking_table(path: Path) -> WalkingTable:
    """Read a table, also that of a run that was killed.

    Raises:
        UsageError: it is missing, or no such table.
    """
    if not path.exists():
        raise UsageError(
            f"{path.parent} does not tell how it walked: it has no {path.name}; run it again"
        )
    header, content = read_headed(path, MAGIC, "walking table")
    try:
        names = [str(name) for name in header["columns"]]
        centre, half_length, half_width = map(float, header["sole"])
        limits = dict(zip(LEG_JOINTS, map(float, header["torque_limit"]), strict=True))
    except (ValueError, TypeError, KeyError) as error:
        raise UsageError(f"{path} has no whole header") from error
    missing = [name for name in COLUMNS if name not in names]
    if missing:
        raise UsageError(
            f"{path} is of another version of hsr8: it has no column {', '.join(missing)}; "
            "run it again"
        )
    row = _row_type(len(names))
    table = np.frombuffer(content, dtype=row, count=len(content) // row.itemsize)
    time, values = table["time"].astype(np.float64), table["values"].astype(np.float64)
    known = np.isin(values[:, names.index("phase")], range(len(PHASES)))
    whole = known & np.isfinite(time) & ~np.isinf(values).any(axis=1)
    if not whole.all():
        raise UsageError(f"{path} is damaged in row {int(np.argmin(whole))}")
    return WalkingTable(
        time=time,
        columns={name: values[:, k] for k, name in enumerate(names)},
        sole=(centre, half_length, half_width),
        torque_limit=limits,
    )


class OdometryToWorld:
    """Puts what the robot knows in its odometry frame where the robot truly is.

    Args:
        record: of the moment.
    """

    def __init__(self, record: TickRecord) -> None:
        here = record.walking.odometry
        x, y, yaw = record.truth.robot.tolist()
        self.turn = yaw - here.yaw
        self._c, self._s = cos(self.turn), sin(self.turn)
        self._x = x - self._c * here.x + self._s * here.y
        self._y = y - self._s * here.x - self._c * here.y

    def point(self, point: Sequence[float] | Array) -> tuple[float, float]:
        """A point of the odometry frame in W [m]."""
        x, y = float(point[0]), float(point[1])
        return self._x + self._c * x - self._s * y, self._y + self._s * x + self._c * y

    def vector(self, vector: Sequence[float] | Array) -> tuple[float, float]:
        """A direction of the odometry frame in W."""
        x, y = float(vector[0]), float(vector[1])
        return self._c * x - self._s * y, self._s * x + self._c * y


def _row(record: TickRecord) -> list[float]:
    truth, walking, balance = record.truth, record.walking, record.walking.balance
    there = OdometryToWorld(record)
    force = truth.foot_force.tolist()
    pressure = truth.zmp.tolist() if sum(force) > LIGHT else [float("nan")] * 2
    row: list[float] = [PHASES.index(walking.phase), walking.step_count]
    row += record.command.velocity
    row += walking.given.tolist()
    row += truth.robot.tolist()
    row += (*there.point(walking.zmp), *pressure)
    row += (*there.point(balance.com), *there.point(walking.com))
    row += (*there.point(walking.dcm), *there.point(balance.dcm))
    for (x, y, z, yaw), load in zip(balance.feet.tolist(), force, strict=True):
        row += (*there.point((x, y)), z, yaw + there.turn, load)
    row += there.vector(balance.capture)
    row += (balance.zmp_depth, walking.roll, walking.pitch)
    limits = walking.admission.limits if walking.admission is not None else ()
    row.append(sum({1 << LIMITS.index(limit) for limit in limits}))
    if truth.pushes:
        push = truth.pushes[0]
        row += (*push.point.tolist(), *push.force.tolist(), push.begin, push.impulse)
    else:
        row += [0.0] * 8
    row += truth.joint_torque[: len(LEG_JOINTS)].tolist()
    return row


def _row_type(columns: int) -> np.dtype[np.void]:
    """A row of the file."""
    return np.dtype([("time", "<f8"), ("values", "<f4", (columns,))])
