"""Walking of a run in the world frame W: ZMP, CoM, DCM, feet, velocities and torques, for plots.

Points known in the odometry frame are transformed with the true pose of the robot, so that planned
and true curves can be compared.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import hypot

import numpy as np
from numpy.typing import NDArray

from hsr8.recorder.limit_bits import LIMITS
from hsr8.recorder.run.run import Run
from hsr8.recorder.table import Table
from hsr8.recorder.world_frame import LIGHT, WorldFrame
from hsr8.robots.loaded import load_robot
from walking.command_limits import Limit
from walking.phase import Phase

Array = NDArray[np.float64]

PHASES = tuple(Phase)
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
        """Return one column (n,)."""
        return self.columns[name]

    def points(self, name: str) -> Array:
        """Return both coordinates of a point (n, 2) [m], for example ``zmp`` or ``left``."""
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


def walking_of(run: Run) -> WalkingTable:
    """Return the walking of a run."""
    robot, records = load_robot(run.scenario().robot.model).model, run.records
    legs, sole = robot.names[:12], robot.sole
    torques = [f"torque_{name}" for name in legs]
    values = _values(records)
    return WalkingTable(
        time=records["time"],
        columns={name: values[:, k] for k, name in enumerate((*COLUMNS, *torques))},
        sole=(sole.centre, sole.half_length, sole.half_width),
        torque_limit=dict(zip(legs, robot.tree.effort[:12].tolist(), strict=True)),
        groups={name: tuple(joints) for name, joints in robot.leg_groups().items()},
    )


def _values(records: Table) -> Array:
    """Return all columns except the time (n, columns)."""
    n, frame = len(records), WorldFrame(records)
    force = records["foot_load"]
    loaded = force.sum(axis=1, keepdims=True) > LIGHT
    feet = records["feet"].copy()
    feet[..., :2], feet[..., 3] = frame.point(feet[..., :2]), feet[..., 3] + frame.turn[:, None]
    points = np.stack(
        [records[name] for name in ("com", "measured_com", "dcm", "measured_dcm")], axis=1
    )
    return np.column_stack(
        [
            [PHASES.index(Phase(phase)) for phase in records["phase"]],
            records["step_count"],
            records["command"],
            records["applied_velocity"],
            records["robot"],
            frame.point(records["zmp"]),
            np.where(loaded, records["cop"], np.nan),
            frame.point(points).reshape(n, -1),
            np.dstack([feet, force]).reshape(n, -1),
            frame.vector(records["capture"]),
            records["zmp_depth"],
            records["roll"],
            records["pitch"],
            records["limits"],
            _pushes(records),
            records["joint_torque"][:, :12],
        ]
    )


def _pushes(records: Table) -> Array:
    """Return point, force, begin and impulse of the first push of each row (n, 8); else zeros."""
    pushes, values = records["pushes"], np.zeros((len(records), 8))
    for k in reversed(range(len(pushes))):
        force, begin = pushes["force"][k], pushes["begin"][k]
        impulse = hypot(*force.tolist()) * pushes["duration"][k]
        values[pushes.parents[k]] = (*pushes["point"][k], *force, begin, impulse)
    return values
