"""Walking: ZMP, CoM, DCM and soles on the floor and over time, torques, pushes."""

from collections import deque
from collections.abc import Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.record import TickRecord
from hsr8.recorder import palette
from hsr8.recorder.arc import mean_velocity
from hsr8.recorder.log.block_stream import BlockStream
from hsr8.recorder.log.channel import Channel
from hsr8.recorder.log.plot_layer import BLUE, GREEN, GREY, ORANGE, RED, SAND, VIOLET, Curves, Lane
from hsr8.recorder.log.record_frame import LIGHT, OdometryToWorld
from navigation.angles import wrap
from walking.body.robot_model import RobotModel
from walking.command_limits import Limit
from walking.robot_measures import HSR_VIII
from walking.state import WalkingState

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
STRIDE = 2  # footsteps over which the achieved velocity is measured
IDLE_WINDOW = 1.0  # of the achieved velocity without footsteps [s]
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
        self._meter = _Speedometer()
        self._interval: tuple[str, int] | None = None
        self._active: tuple[Limit, ...] = ()
        self._pushed = False

    def add(self, records: Sequence[TickRecord]) -> None:
        """Take records at the rate of the plots."""
        times, truths = [r.time for r in records], [r.truth for r in records]
        walks = [record.walking for record in records]
        transform = OdometryToWorld(records)
        known = [(walking.zmp, walking.balance.com, walking.balance.dcm) for walking in walks]
        planned, com, dcm = transform.point(np.array(known)).swapaxes(0, 1)
        loaded = np.array([truth.foot_force for truth in truths]).sum(axis=1) > LIGHT
        zmp = np.array([truth.zmp for truth in truths])
        measured = np.where(loaded[:, None], zmp, np.nan)
        corners = [len(walking.balance.support) for walking in walks]
        rows = np.repeat(np.arange(len(walks)), corners)
        support = transform.point(np.concatenate([w.balance.support for w in walks]), rows)
        points = np.stack([planned, measured, com, dcm], axis=1)
        self._add_curves(times, np.array([t.robot for t in truths]), points, support, rows)
        points[:, 1] = np.where(np.isnan(measured[:, :1]), planned, measured)
        pins = np.full((len(times), len(POINTS), 3), self._pin)
        pins[..., :2] = points
        self._points.add_rows(times, [len(POINTS)] * len(times), origins=pins.reshape(-1, 3))
        commanded = np.array([record.command.velocity for record in records])
        applied = np.array([walking.applied_velocity for walking in walks])
        for curves, a, g in zip(self._commanded, commanded.T, applied.T, strict=True):
            curves.add(times, np.column_stack([a, g]))
        torque = np.array([truth.joint_torque for truth in truths])
        for curves, columns in self._torque:
            curves.add(times, torque[:, columns])
        self._tilt.add(times, np.degrees([(walking.roll, walking.pitch) for walking in walks]))
        for record, area in zip(records, np.split(support, np.cumsum(corners[:-1])), strict=True):
            self._add_gait(record.time, record.walking, area)
            self._log_limits(record)

    def watch(self, record: TickRecord) -> None:
        """Take every record, for footsteps and pushes shorter than the period of the plots."""
        measured = self._meter.add(record)
        if measured is not None:
            time, velocity = measured
            for curves, value in zip(self._achieved, velocity, strict=True):
                curves.add([time], np.array([[value]]))
        pushes = record.truth.pushes
        if pushes or self._pushed:
            self._pushed = bool(pushes)
            vectors = self._arrow * np.array([p.force for p in pushes]).reshape(-1, 3)
            reach = 1.0 + self._gap / np.maximum(
                np.linalg.norm(vectors, axis=1, keepdims=True), 1e-9
            )
            origins = np.array([p.point for p in pushes]).reshape(-1, 3) - reach * vectors
            self._pushes.add(record.time, origins=origins, vectors=vectors)

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

    def _add_gait(self, time: float, walking: WalkingState, support: Array) -> None:
        """Add the phase and, if it is new, the support polygon (n, 2) in W [m]."""
        self._phase.add(time, str(walking.phase))
        interval = (str(walking.phase), walking.step_count)
        if interval != self._interval:
            self._interval = interval
            strip = np.full((len(support) + 1, 3), FLOOR)
            strip[:, :2] = *support, support[0]
            self._support.add(time, strips=[strip])

    def _log_limits(self, record: TickRecord) -> None:
        report = record.walking.command_limits
        limits = () if report is None else report.limits
        active = tuple(dict.fromkeys(limit for limit in limits if limit is not ROUTINE))
        if active == self._active or report is None:
            return
        self._active = active
        commanded = report.commanded.velocity
        applied = record.walking.applied_velocity.tolist()
        text = "obeyed" if not active else ", ".join(active)
        line = f"{text}: commanded {_described(commanded)}, applied {_described(applied)}"
        self._limits.add(record.time, text=[line], level=["WARN" if active else "INFO"])


class _Speedometer:
    """Mean velocity over one stride, once per footstep."""

    def __init__(self) -> None:
        self._marks: deque[tuple[float, Array]] = deque(maxlen=STRIDE + 1)
        self._steps = 0
        self._yaw = 0.0

    def add(self, record: TickRecord) -> tuple[float, list[float]] | None:
        """Return the middle of the stride [s] and the velocity, if a stride ends."""
        x, y, yaw = record.truth.robot.tolist()
        self._yaw += wrap(yaw - self._yaw)
        idle = not self._marks or record.time - self._marks[-1][0] >= IDLE_WINDOW - 1e-9
        if record.walking.step_count == self._steps and not idle:
            return None
        self._steps = record.walking.step_count
        pose = np.array([x, y, self._yaw])
        self._marks.append((record.time, pose))
        first, start = self._marks[0] if not idle else self._marks[max(0, len(self._marks) - 2)]
        if record.time - first <= 0.0:
            return None
        elapsed = record.time - first
        return first + 0.5 * elapsed, mean_velocity(start, pose, elapsed).tolist()


def _described(velocity: tuple[float, ...] | list[float]) -> str:
    vx, vy, wz = velocity
    return f"{vx:.2f} {vy:.2f} m/s {wz:.2f} rad/s"
