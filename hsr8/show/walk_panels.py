"""Panels of a figure of walking; each function draws into one pair of axes."""

from collections.abc import Sequence
from math import cos, degrees, isfinite, sin

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.patches import Patch
from numpy.typing import NDArray

from hsr8.recording.derived import STRIDE, Speedometer, Walk, pushes_of
from hsr8.recording.rows import LIMITS
from walking.command import Limit
from walking.state import Phase

Array = NDArray[np.float64]

# Colours distinguishable with colour vision deficiency (Okabe and Ito).
BLUE, SKY, GREEN = "#0072B2", "#56B4E9", "#009E73"
VERMILION, ORANGE, PURPLE, INK = "#D55E00", "#E69F00", "#AA4499", "#222222"
LEFT, RIGHT = BLUE, VERMILION
FEET = (LEFT, RIGHT)
SWINGS = (Phase.RIGHT_SUPPORT, Phase.LEFT_SUPPORT)  # phases in which a foot is in the air
PUSH = "#CC0044"
CURVES = (
    ("cop", "ZMP measured", SKY, 0.9, "-"),
    ("zmp", "ZMP planned", VERMILION, 1.3, "-"),
    ("dcm", "DCM planned", PURPLE, 1.0, "--"),
    ("measured_dcm", "DCM measured", PURPLE, 0.8, ":"),
    ("com", "CoM planned", GREEN, 1.3, "-"),
    ("measured_com", "CoM measured", GREEN, 0.9, ":"),
)
LANES = {
    Phase.STANDING: "#BBBBBB",
    Phase.DOUBLE_SUPPORT: "#DDCC77",
    Phase.LEFT_SUPPORT: LEFT,
    Phase.RIGHT_SUPPORT: RIGHT,
    Phase.GETTING_UP: PURPLE,
    Phase.FALLEN: PUSH,
}
PHASE_NAMES = {
    Phase.STANDING: "standing",
    Phase.DOUBLE_SUPPORT: "double support",
    Phase.LEFT_SUPPORT: "on the left foot",
    Phase.RIGHT_SUPPORT: "on the right foot",
    Phase.GETTING_UP: "getting up",
    Phase.FALLEN: "fallen",
}
FOOTHOLD = 0.0005  # a foot lower than this is on the floor [m]
MIN_SPANS = (0.1, 0.1, 0.4)  # of the shown ranges of vx, vy [m/s] and wz [rad/s]
DEFAULT_STRIDE = 0.7  # window of the velocity without footsteps [s]
GROUPS = ("hip", "knee", "ankle")
DASHES = ("-", (0, (4, 1.5)), (0, (1, 1)))


def contacts(walk: Walk, foot: int) -> list[tuple[int, int]]:
    """Return first and last row of every planned contact of a foot with the floor.

    Args:
        walk: walking of the run.
        foot: 0 left, 1 right.
    """
    phase, lying = walk.records["phase"], [str(p) for p in Phase if p.down]
    swinging = (phase == str(SWINGS[foot])) & (walk.feet[:, foot, 2] >= FOOTHOLD)
    down = ~swinging & ~np.isin(phase, lying)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], down.astype(int), [0]])))
    return [(a, b - 1) for a, b in edges.reshape(-1, 2).tolist() if b - a > 1]


def outline(walk: Walk, foot: int, rows: tuple[int, int]) -> Array:
    """Return the corners of a sole in W (4, 2) [m] during a contact; arguments as of `contacts`."""
    poses, sole = walk.feet[rows[0] : rows[1] + 1, foot], walk.model.sole
    x, y = np.median(poses[:, :2], axis=0).tolist()
    yaw = float(np.median(np.unwrap(poses[:, 3])))
    c, s = cos(yaw), sin(yaw)
    corners = [
        (sole.centre + u * sole.half_length, v * sole.half_width)
        for u, v in ((1, 1), (1, -1), (-1, -1), (-1, 1))
    ]
    return np.array([[x + c * u - s * v, y + s * u + c * v] for u, v in corners])


def to_local(points: Array, origin: Array, yaw: float) -> Array:
    """Transform points from W to the frame of a pose (n, 2) [m]."""
    c, s = cos(yaw), sin(yaw)
    local: Array = (points - origin) @ np.array([[c, -s], [s, c]])
    return local


class WalkingFrame:
    """Frame of the robot without sway: its pose averaged over one stride.

    Args:
        walk: walking of the run.
    """

    def __init__(self, walk: Walk) -> None:
        poses = walk.pose
        width = min(_stride_rows(walk), len(walk))
        # Extrapolate both ends at constant velocity, so that the average does not lag.
        before, after = width // 2, width - 1 - width // 2
        first = poses[0] - (poses[min(width, len(poses) - 1)] - poses[0]) * _ramp(before, width)
        last = poses[-1] + (poses[-1] - poses[-1 - min(width, len(poses) - 1)]) * _ramp(
            after, width
        )
        padded = np.concatenate([first[::-1], poses, last])
        sums = np.cumsum(np.concatenate([np.zeros((1, 3)), padded]), axis=0)
        mean = (sums[width:] - sums[:-width]) / width
        self._origin = mean[:, :2]
        self._c, self._s = np.cos(mean[:, 2]), np.sin(mean[:, 2])

    def to_local(self, points: Array, rows: slice = slice(None)) -> Array:
        """Transform points from W to the frames of some rows [m].

        Args:
            points: one per row (n, 2), or one for all rows (2,).
            rows: all by default.
        """
        dx, dy = (points - self._origin[rows]).T
        c, s = self._c[rows], self._s[rows]
        return np.column_stack([c * dx + s * dy, c * dy - s * dx])


def along(axes: Axes, walk: Walk, axis: int) -> None:
    """Draw ZMP, CoM, DCM and soles along one axis of the robot over time.

    Args:
        axes: axes to draw into.
        walk: walking of the run.
        axis: 0 forward, 1 left.
    """
    frame = WalkingFrame(walk)
    for foot, color in enumerate(FEET):
        bands = []
        for first, last in contacts(walk, foot):
            sole = outline(walk, foot, (first, last))
            rows = slice(first, last + 1)
            corners = np.array([frame.to_local(corner, rows)[:, axis] for corner in sole])
            upper = np.column_stack([walk.time[rows], corners.max(axis=0)])
            lower = np.column_stack([walk.time[rows], corners.min(axis=0)])
            bands.append(np.vstack([upper, lower[::-1]]))
        axes.add_collection(PolyCollection(bands, color=color, alpha=0.16, lw=0))
    for name, label, color, width, dash in CURVES:
        axes.plot(
            walk.time,
            frame.to_local(getattr(walk, name))[:, axis],
            color=color,
            lw=width,
            ls=dash,
            label=label,
        )
    axes.set_ylabel(("forward\n[m]", "left\n[m]")[axis])
    if axis == 0:
        axes.set_title("in the frame of the body, without sway", loc="left", fontsize="small")


def sole_legend() -> list[Patch]:
    """Return the legend of the bands of `along`."""
    return [
        Patch(color=LEFT, alpha=0.16, lw=0, label="left sole"),
        Patch(color=RIGHT, alpha=0.16, lw=0, label="right sole"),
    ]


def velocity(axes: Axes, walk: Walk, component: int) -> None:
    """Draw the commanded, applied and achieved velocity; component 0 vx, 1 vy, 2 wz."""
    for name, label, color, width, dash in (
        ("command", "commanded", INK, 0.9, "--"),
        ("applied_velocity", "applied", ORANGE, 1.3, "-"),
    ):
        values = walk.records[name][:, component]
        axes.plot(walk.time, values, color=color, lw=width, ls=dash, label=label)
    time, achieved = achieved_velocity(walk)
    if len(time):
        axes.plot(time, achieved[:, component], color=BLUE, lw=1.3, label="achieved")
    _at_least(axes, MIN_SPANS[component])
    axes.set_ylabel(("vx\n[m/s]", "vy\n[m/s]", "wz\n[rad/s]")[component])


def achieved_velocity(walk: Walk) -> tuple[Array, Array]:
    """Return the middle of each stride (n,) [s] and the velocity over it (n, 3)."""
    measured = [*Speedometer().add(walk.records)]
    return np.array([time for time, _ in measured]), np.reshape([v for _, v in measured], (-1, 3))


def _stride_rows(walk: Walk) -> int:
    """Return the number of rows per stride."""
    period = float(np.median(np.diff(walk.time)))
    changes = walk.time[np.flatnonzero(np.diff(walk.records["step_count"]) > 0)]
    stride = DEFAULT_STRIDE
    if len(changes) > STRIDE:
        stride = STRIDE * float(np.median(np.diff(changes)))
    return max(1, round(stride / period))


def _ramp(count: int, width: int) -> Array:
    """Return the fractions of a stride at the `count` rows beyond the end (count, 1)."""
    return (np.arange(1, count + 1) / width)[:, None]


def _at_least(axes: Axes, span: float) -> None:
    """Widen the range of y to `span`, so that noise does not fill the panel."""
    low, high = axes.get_ylim()
    missing = max(0.0, span - (high - low))
    axes.set_ylim(low - 0.5 * missing, high + 0.5 * missing)


def torque(axes: Axes, walk: Walk, group: str) -> None:
    """Draw the torques of one group of leg joints and their limits."""
    names, effort = walk.model.names, walk.model.tree.effort
    limit_max = 0.0
    for joint, dash in zip(walk.model.leg_groups()[group], DASHES, strict=False):
        for k, color in ((joint, LEFT), (6 + joint, RIGHT)):
            torques, label = walk.records["joint_torque"][:, k], names[k].replace("_", " ")
            axes.plot(walk.time, torques, color=color, lw=0.9, ls=dash, label=label)
            limit_max = max(limit_max, float(effort[k]))
    if isfinite(limit_max):
        for limit in (-limit_max, limit_max):
            axes.axhline(limit, color=PUSH, lw=0.9, ls=(0, (6, 2)))
        axes.set_ylim(-1.12 * limit_max, 1.12 * limit_max)
    axes.set_ylabel(f"{group}\n[N m]")


def tilt(axes: Axes, walk: Walk) -> None:
    """Draw the measured roll and pitch of the trunk."""
    for name, color in (("roll", BLUE), ("pitch", ORANGE)):
        axes.plot(walk.time, np.degrees(walk.records[name]), color=color, lw=1.0, label=name)
    most = max(
        2.0, 1.15 * degrees(float(np.abs([walk.records["roll"], walk.records["pitch"]]).max()))
    )
    axes.set_ylim(-most, most)
    axes.set_ylabel("trunk tilt\n[deg]")


def lanes(axes: Axes, walk: Walk) -> None:
    """Draw the gait phase and the active limits of the command over time."""
    end = walk.time[-1] + float(np.median(np.diff(walk.time)))
    for phase in Phase:
        runs = _runs(walk.time, walk.records["phase"] == str(phase), end)
        axes.broken_barh(runs, (0.0, 0.8), color=LANES[phase], alpha=0.75, lw=0)
    names = ["gait phase"]
    for limit, rows in active_limits(walk).items():
        axes.broken_barh(_runs(walk.time, rows, end), (len(names), 0.8), color=INK, lw=0)
        names.append(str(limit))
    axes.set_yticks([k + 0.4 for k in range(len(names))], names, fontsize="x-small")
    axes.set_ylim(len(names), -0.2)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False)


def lane_legend(walk: Walk) -> list[Patch]:
    """Return the legend of the gait phases, with falls only if there are any."""
    present = {*walk.records["phase"]}
    return [
        Patch(color=LANES[p], alpha=0.75, lw=0, label=text)
        for p, text in PHASE_NAMES.items()
        if str(p) in present or not p.down
    ]


def mark_pushes(panels: Sequence[Axes], walk: Walk) -> None:
    """Draw a line for every push into all panels over time."""
    for push in pushes_of(walk.records):
        for axes in panels:
            axes.axvline(push.begin, color=PUSH, lw=0.8, alpha=0.8, zorder=0)


def active_limits(walk: Walk) -> dict[Limit, NDArray[np.bool_]]:
    """Return the rows (n,) in which each limit was active, without limits that never were."""
    mask = walk.records["limits"]
    active = {limit: (mask >> k) & 1 == 1 for k, limit in enumerate(LIMITS)}
    return {limit: rows for limit, rows in active.items() if rows.any()}


def _runs(time: Array, chosen: NDArray[np.bool_], end: float) -> list[tuple[float, float]]:
    """Return start and length of every interval of chosen rows [s]."""
    ends = np.append(time[1:], end)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], chosen.astype(int), [0]])))
    return [
        (float(time[a]), float(ends[b - 1] - time[a])) for a, b in edges.reshape(-1, 2).tolist()
    ]
