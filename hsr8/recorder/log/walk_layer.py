"""Walking: ZMP, CoM, DCM and soles on the floor and over time, torques, pushes."""

from collections.abc import Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recorder import palette
from hsr8.recorder.derived import Speedometer, WorldFrame, loaded_cop
from hsr8.recorder.limit_bits import LIMITS, limit_bits
from hsr8.recorder.log.channel import BlockStream, Channel
from hsr8.recorder.log.plot_layer import BLUE, GREEN, GREY, ORANGE, RED, SAND, VIOLET, Curves, Lane
from hsr8.recorder.table import Table
from walking.body.robot_model import RobotModel
from walking.command_limits import Limit
from walking.robot_measures import HSR_VIII

Array = NDArray[np.float64]

GAIT = {
    "standing": GREY,
    "double": SAND,
    "left": BLUE,
    "right": ORANGE,
    "up": VIOLET,
    "fallen": RED,
}
POINTS = (("ZMP planned", ORANGE), ("ZMP measured", BLUE), ("CoM", GREEN), ("DCM", VIOLET))
FLOOR = 0.006  # height of drawings on the floor [m]
# For the default robot; forces are relative to the weight of the robot, lengths to its height.
PIN = 0.16  # height of the pins that mark points on the floor [m]
ARROW = 0.025  # drawn length of a push per newton [m/N]
GAP = 0.07  # between the tip of an arrow and the point of action [m]
ROUTINE = Limit.LANDING_FROZEN  # active at the end of every step, not logged
SIDES = ((BLUE, SAND, GREEN, GREY), (ORANGE, RED, VIOLET, GREY))  # of left and right leg


class WalkLayer:
    """Layer of walking.

    Args:
        stream: recording.
        robot: that walks.
        scale: height of the robot relative to the default robot [1].
    """

    def __init__(self, stream: BlockStream, robot: RobotModel, scale: float = 1.0) -> None:
        self._pin, self._gap = PIN * scale, GAP * scale
        self._arrow = ARROW * scale * HSR_VIII.weight / robot.measures().weight
        self._points = Channel(
            stream,
            "/world/walking/points",
            rr.Arrows3D,
            colors=[color for _, color in POINTS],
            radii=[0.003 * scale],
            vectors=np.tile([0.0, 0.0, FLOOR - self._pin], (len(POINTS), 1)),
        )
        edge = {"colors": [palette.TARGET], "radii": [0.0025 * scale]}
        self._support = Channel(stream, "/world/walking/support", rr.LineStrips3D, **edge)
        self._pushes = Channel(
            stream, "/world/pushes", rr.Arrows3D, colors=[RED], radii=[0.012 * scale]
        )
        curves = (*POINTS, ("edge of the soles", GREY), ("edge of the soles", GREY))
        self._zmp = tuple(
            Curves(stream, f"/plots/zmp_{axis}", curves) for axis in ("forward", "left")
        )
        speeds = ("vx [m/s]", "vy [m/s]", "wz [rad/s]")
        self._commanded = tuple(
            Curves(
                stream,
                f"/plots/speed_{name.split()[0]}/commanded",
                ((f"commanded, {name}", GREY), (f"applied, {name}", ORANGE)),
            )
            for name in speeds
        )
        self._achieved = tuple(
            Curves(
                stream, f"/plots/speed_{name.split()[0]}/achieved", ((f"achieved, {name}", BLUE),)
            )
            for name in speeds
        )
        self._torque = tuple(
            self._torque_curves(stream, robot.names, group, joints)
            for group, joints in robot.leg_groups().items()
        )
        self._tilt = Curves(stream, "/plots/tilt", (("roll [deg]", BLUE), ("pitch [deg]", ORANGE)))
        self._phase = Lane(stream, "/state/gait", GAIT)
        self._limits = Channel(stream, "/command_limits", rr.TextLog)
        self._meter = Speedometer()
        self._interval: tuple[str, int] | None = None
        self._active = 0  # limits, one bit each
        self._pushed = False

    def add(self, records: Table) -> None:
        """Take records at the rate of the plots."""
        times, frame = records["time"].tolist(), WorldFrame(records)
        planned, com, dcm = (frame.point(records[name]) for name in ("zmp", "com", "measured_dcm"))
        measured = loaded_cop(records)
        corners = [len(area) for area in records["support"]]
        rows = np.repeat(np.arange(len(times)), corners)
        support = frame.point(np.concatenate(records["support"]), rows)
        points = np.stack([planned, measured, com, dcm], axis=1)
        self._add_curves(times, records["robot"], points, support, rows)
        points[:, 1] = np.where(np.isnan(measured[:, :1]), planned, measured)
        pins = np.full((len(times), len(POINTS), 3), self._pin)
        pins[..., :2] = points
        self._points.add_rows(times, [len(POINTS)] * len(times), origins=pins.reshape(-1, 3))
        commanded, applied = records["command"], records["applied_velocity"]
        for curves, a, g in zip(self._commanded, commanded.T, applied.T, strict=True):
            curves.add(times, np.column_stack([a, g]))
        for curves, columns in self._torque:
            curves.add(times, records["joint_torque"][:, columns])
        tilt = np.column_stack([records["roll"], records["pitch"]])
        self._tilt.add(times, np.degrees(tilt))
        self._add_gait(times, records, np.split(support, np.cumsum(corners[:-1])))
        self._log_limits(records)

    def watch(self, records: Table) -> None:
        """Take every record, for footsteps and pushes shorter than the period of the plots."""
        for middle, velocity in self._meter.add(records):
            for curves, value in zip(self._achieved, velocity.tolist(), strict=True):
                curves.add([middle], np.array([[value]]))
        pushes = records["pushes"]
        vectors = self._arrow * pushes["force"]
        reach = 1.0 + self._gap / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-9)
        origins = pushes["point"] - reach * vectors
        # An empty row ends the display of the last push.
        pushed = np.concatenate([[self._pushed], pushes.counts > 0])
        shown = np.flatnonzero(pushed[1:] | pushed[:-1])
        self._pushed = bool(pushed[-1])
        self._pushes.add_rows(
            records["time"][shown].tolist(),
            pushes.counts[shown].tolist(),
            origins=origins,
            vectors=vectors,
        )

    @staticmethod
    def _torque_curves(
        stream: BlockStream, names: Sequence[str], group: str, joints: Sequence[int]
    ) -> tuple[Curves, list[int]]:
        columns = [*joints, *(6 + k for k in joints)]
        shades = [color for side in SIDES for color, _ in zip(side, joints, strict=False)]
        named = [
            (f"{names[k].replace('_', ' ')} [N m]", shade)
            for k, shade in zip(columns, shades, strict=True)
        ]
        return Curves(stream, f"/plots/torque_{group}", named), columns

    def _add_curves(
        self,
        times: list[float],
        robot: Array,
        points: Array,
        support: Array,
        rows: NDArray[np.intp],
    ) -> None:
        """Add points (n, 4, 2), and corners of the soles (m, 2) with the row of each."""
        position, yaw = robot[:, :2], robot[:, 2]
        c, s = np.cos(yaw), np.sin(yaw)
        x, y = (points - position[:, None]).T
        edge_x, edge_y = (support - position[rows]).T
        firsts = np.searchsorted(rows, np.arange(len(times)))
        # Along the axes of the robot.
        for curves, (along, across) in zip(self._zmp, ((c, s), (-s, c)), strict=True):
            edges = along[rows] * edge_x + across[rows] * edge_y
            ends = np.minimum.reduceat(edges, firsts), np.maximum.reduceat(edges, firsts)
            curves.add(times, np.column_stack([(along * x + across * y).T, *ends]))

    def _add_gait(self, times: list[float], records: Table, support: list[Array]) -> None:
        """Add the phase and, if it is new, the support polygon (m, 2) in W of each row [m]."""
        rows = zip(times, records["phase"], records["step_count"].tolist(), support, strict=True)
        for time, phase, steps, area in rows:
            self._phase.add(time, phase)
            if (phase, steps) != self._interval:
                self._interval = (phase, steps)
                strip = np.full((len(area) + 1, 3), FLOOR)
                strip[:, :2] = *area, area[0]
                self._support.add(time, strips=[strip])

    def _log_limits(self, records: Table) -> None:
        known = np.isfinite(records["limited_command"]).all(axis=1)
        active = np.where(known, records["limits"] & ~limit_bits((ROUTINE,)), self._active)
        before = np.concatenate([[self._active], active[:-1]])
        self._active = int(active[-1])
        for row in np.flatnonzero(active != before).tolist():
            names = [limit for k, limit in enumerate(LIMITS) if active[row] >> k & 1]
            commanded = _described(records["limited_command"][row])
            applied = _described(records["applied_velocity"][row])
            text = ", ".join(names) or "obeyed"
            line = f"{text}: commanded {commanded}, applied {applied}"
            level = "WARN" if names else "INFO"
            self._limits.add(float(records["time"][row]), text=[line], level=[level])


def _described(velocity: Array) -> str:
    vx, vy, wz = velocity.tolist()
    return f"{vx:.2f} {vy:.2f} m/s {wz:.2f} rad/s"
