"""Walking: ZMP, CoM, DCM and soles on the floor and over time, torques, pushes."""

from collections.abc import Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recording import palette
from hsr8.recording.derived import Speedometer, WorldFrame, loaded_cop
from hsr8.recording.rows import LIMITS, limit_bits
from hsr8.recording.table import Table
from hsr8.show.log.decisions import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    RED,
    SAND,
    VIOLET,
    Curves,
    style_plots,
)
from hsr8.show.log.shapes import raised
from hsr8.show.log.stream import LogStream
from walking.body.robot_model import RobotModel
from walking.command import Limit
from walking.dimension import HSR_VIII
from walking.state import Phase

Array = NDArray[np.float64]

GAIT = {  # name and colour of a phase
    Phase.STANDING: ("standing", GREY),
    Phase.DOUBLE_SUPPORT: ("both feet", SAND),
    Phase.LEFT_SUPPORT: ("left foot", BLUE),
    Phase.RIGHT_SUPPORT: ("right foot", ORANGE),
    Phase.GETTING_UP: ("getting up", VIOLET),
    Phase.FALLEN: ("fallen", RED),
}
POINTS = (("ZMP planned", ORANGE), ("ZMP measured", BLUE), ("CoM", GREEN), ("DCM", VIOLET))
SPEEDS = ("vx", "vy", "wz")
POINTS_PATH = "/world/walking/points"
FLOOR = 0.006  # height of drawings on the floor [m]
# For the default robot; forces are relative to the weight of the robot, lengths to its height.
PIN = 0.16  # height of the pins that mark points on the floor [m]
ARROW = 0.025  # drawn length of a push per newton [m/N]
GAP = 0.07  # between the tip of an arrow and the point of action [m]
ROUTINE = Limit.LANDING_FROZEN  # active at the end of every step, not logged
SIDES = ((BLUE, SAND, GREEN, GREY), (ORANGE, RED, VIOLET, GREY))  # of left and right leg


def style_walking(log: LogStream, robot: RobotModel, scale: float) -> None:
    """Set the styles of walking.

    Args:
        log: recording.
        robot: model of the robot.
        scale: height of the robot relative to the default robot [1].
    """
    log.style(
        POINTS_PATH,
        rr.Arrows3D,
        colors=[color for _, color in POINTS],
        radii=[0.003 * scale],
        vectors=np.tile([0.0, 0.0, FLOOR - PIN * scale], (len(POINTS), 1)),
    )
    edge = {"colors": [palette.TARGET], "radii": [0.0025 * scale]}
    log.style("/world/walking/support", rr.LineStrips3D, **edge)
    log.style("/world/pushes", rr.Arrows3D, colors=[RED], radii=[0.012 * scale])
    curves = (*POINTS, ("edge of the soles", GREY), ("edge of the soles", GREY))
    plots: dict[str, Curves] = {"zmp_forward": curves, "zmp_left": curves}
    for name, unit in zip(SPEEDS, ("m/s", "m/s", "rad/s"), strict=True):
        plots[f"speed_{name}/commanded"] = (
            (f"commanded, {name} [{unit}]", GREY),
            (f"applied, {name} [{unit}]", ORANGE),
        )
        plots[f"speed_{name}/achieved"] = ((f"achieved, {name} [{unit}]", BLUE),)
    for group, joints in leg_columns(robot).items():
        shades = [side[k] for side in SIDES for k in range(len(joints) // 2)]
        plots[f"torque_{group}"] = tuple(
            (f"{robot.names[k].replace('_', ' ')} [N m]", shade)
            for k, shade in zip(joints, shades, strict=True)
        )
    plots["tilt"] = (("roll [deg]", BLUE), ("pitch [deg]", ORANGE))
    style_plots(log, plots, {"gait": dict(GAIT.values())})


def leg_columns(robot: RobotModel) -> dict[str, list[int]]:
    """Return the numbers of the joints of both legs by group, the left leg first."""
    return {
        group: [*joints, *(6 + k for k in joints)] for group, joints in robot.leg_groups().items()
    }


def log_walking(log: LogStream, records: Table, robot: RobotModel, scale: float) -> None:
    """Log records at the rate of the plots.

    Args:
        log: recording.
        records: rows.
        robot: model of the robot.
        scale: height of the robot relative to the default robot [1].
    """
    times, frame = records["time"], WorldFrame(records)
    planned, com, dcm = (frame.point(records[name]) for name in ("zmp", "com", "measured_dcm"))
    measured = loaded_cop(records)
    corners = [len(area) for area in records["support"]]
    rows = np.repeat(np.arange(len(times)), corners)
    support = frame.point(np.concatenate(records["support"]), rows)
    points = np.stack([planned, measured, com, dcm], axis=1)
    _log_curves(log, records, points, support, rows)
    points[:, 1] = np.where(np.isnan(measured[:, :1]), planned, measured)
    pins = np.full((len(times), len(POINTS), 3), PIN * scale)
    pins[..., :2] = points
    counts = np.full(len(times), len(POINTS))
    log.rows(POINTS_PATH, rr.Arrows3D, times, counts, origins=pins.reshape(-1, 3))
    velocities = zip(SPEEDS, records["command"].T, records["applied_velocity"].T, strict=True)
    for name, commanded, applied in velocities:
        path = f"/plots/speed_{name}/commanded"
        log.curves(path, times, np.column_stack([commanded, applied]))
    for group, joints in leg_columns(robot).items():
        log.curves(f"/plots/torque_{group}", times, records["joint_torque"][:, joints])
    tilt = np.column_stack([records["roll"], records["pitch"]])
    log.curves("/plots/tilt", times, np.degrees(tilt))
    log.lane("/state/gait", times, [GAIT[Phase(phase)][0] for phase in records["phase"]])
    _log_support(log, records, np.split(support, np.cumsum(corners[:-1])))
    _log_limits(log, records)


def log_every_record(
    log: LogStream, records: Table, meter: Speedometer, robot: RobotModel, scale: float
) -> None:
    """Log the velocities of strides, and pushes, which may be shorter than the period of the plots.

    Args:
        log: recording.
        records: all new rows.
        meter: speedometer of the run.
        robot: model of the robot.
        scale: height of the robot relative to the default robot [1].
    """
    strides = [*meter.add(records)]
    middles = np.array([middle for middle, _ in strides])
    for k, name in enumerate(SPEEDS):
        values = np.array([velocity[k] for _, velocity in strides])
        log.rows(f"/plots/speed_{name}/achieved", rr.Scalars, middles, scalars=values)
    pushes = records["pushes"]
    length = ARROW * scale * HSR_VIII.weight / robot.measures().weight
    vectors = length * pushes["force"]
    norms = np.linalg.norm(vectors, axis=1, keepdims=True)
    reach = 1.0 + GAP * scale / np.maximum(norms, 1e-9)
    pushed = pushes.counts > 0
    # An empty row ends the display of the last push.
    ends = log.changed("/world/pushes", pushed.tolist(), first=False)
    rows = np.union1d(np.flatnonzero(pushed), ends)
    log.rows(
        "/world/pushes",
        rr.Arrows3D,
        records["time"][rows],
        pushes.counts[rows],
        origins=pushes["point"] - reach * vectors,
        vectors=vectors,
    )


def _log_curves(
    log: LogStream, records: Table, points: Array, support: Array, rows: NDArray[np.intp]
) -> None:
    """Log points (n, 4, 2), and corners of the soles (m, 2) with the row of each, along R."""
    times, position, yaw = records["time"], records["robot"][:, :2], records["robot"][:, 2]
    c, s = np.cos(yaw), np.sin(yaw)
    x, y = (points - position[:, None]).T
    edge_x, edge_y = (support - position[rows]).T
    firsts = np.searchsorted(rows, np.arange(len(times)))
    for axis, along, across in (("forward", c, s), ("left", -s, c)):
        edges = along[rows] * edge_x + across[rows] * edge_y
        ends = np.minimum.reduceat(edges, firsts), np.maximum.reduceat(edges, firsts)
        values = np.column_stack([(along * x + across * y).T, *ends])
        log.curves(f"/plots/zmp_{axis}", times, values)


def _log_support(log: LogStream, records: Table, support: Sequence[Array]) -> None:
    """Log the support polygon (m, 2) in W of each phase [m]."""
    phases = zip(records["phase"], records["step_count"].tolist(), strict=True)
    rows = log.changed("/world/walking/support", [*phases])
    strips = [raised(np.array([*support[row], support[row][0]]), FLOOR) for row in rows.tolist()]
    log.rows("/world/walking/support", rr.LineStrips3D, records["time"][rows], strips=strips)


def _log_limits(log: LogStream, records: Table) -> None:
    """Log the limits of the command when they change."""
    active = records["limits"] & ~limit_bits((ROUTINE,))
    texts, levels = [], []
    rows = log.changed("/command_limits", active.tolist(), first=0)
    for row in rows.tolist():
        names = [limit for k, limit in enumerate(LIMITS) if active[row] >> k & 1]
        commanded = _described(records["limited_command"][row])
        applied = _described(records["applied_velocity"][row])
        text = ", ".join(names) or "obeyed"
        texts.append(f"{text}: commanded {commanded}, applied {applied}")
        levels.append("WARN" if names else "INFO")
    log.rows("/command_limits", rr.TextLog, records["time"][rows], text=texts, level=levels)


def _described(velocity: Array) -> str:
    vx, vy, wz = velocity.tolist()
    return f"{vx:.2f} {vy:.2f} m/s {wz:.2f} rad/s"
