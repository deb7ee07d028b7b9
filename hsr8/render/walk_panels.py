"""The panels of a plot of walking; each draws one thing into one pair of axes."""

from collections.abc import Sequence
from math import cos, degrees, sin

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.patches import Patch
from numpy.typing import NDArray

from hsr8.recorder.arc import mean_velocity
from hsr8.recorder.run.walking_table import PHASES, WalkingTable
from walking.phase import Phase

Array = NDArray[np.float64]

# Colours that people who do not see all colours tell apart (Okabe and Ito).
BLUE, SKY, GREEN = "#0072B2", "#56B4E9", "#009E73"
VERMILION, ORANGE, PURPLE, INK = "#D55E00", "#E69F00", "#AA4499", "#222222"
LEFT, RIGHT = BLUE, VERMILION
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
SPANS = (0.1, 0.1, 0.4)  # least shown range of vx, vy [m/s] and wz [rad/s]
STEPS_PER_STRIDE = 2
ARROW = 0.08  # drawn length of a push [m]
USUAL_STRIDE = 0.7  # over which velocity is measured when nobody steps [s]
JOINTS = {
    "hip": ("hip_yaw", "hip_roll", "hip_pitch"),
    "knee": ("knee",),
    "ankle": ("ankle_pitch", "ankle_roll"),
}
DASHES = ("-", (0, (4, 1.5)), (0, (1, 1)))


def contacts(table: WalkingTable, foot: str) -> list[tuple[int, int]]:
    """Rows, first and last, of every time in which a foot is meant to stand still on the floor."""
    swings = Phase.RIGHT_SUPPORT if foot == "left" else Phase.LEFT_SUPPORT
    phase, lying = table["phase"], [k for k, p in enumerate(PHASES) if p.down]
    swinging = (phase == PHASES.index(swings)) & (table[f"{foot}_z"] >= FOOTHOLD)
    down = ~swinging & ~np.isin(phase, lying)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], down.astype(int), [0]])))
    return [(a, b - 1) for a, b in edges.reshape(-1, 2).tolist() if b - a > 1]


def outline(table: WalkingTable, foot: str, rows: tuple[int, int]) -> Array:
    """Corners of a sole in W (4, 2) [m], where it stood during some rows."""
    chosen = slice(rows[0], rows[1] + 1)
    x, y = np.median(table.points(foot)[chosen], axis=0).tolist()
    yaw = float(np.median(np.unwrap(table[f"{foot}_yaw"][chosen])))
    centre, half_length, half_width = table.sole
    c, s = cos(yaw), sin(yaw)
    corners = [(centre + u * half_length, v * half_width) for u, v in ((1, 1), (1, -1), (-1, -1))]
    corners.append((centre - half_length, half_width))
    return np.array([[x + c * u - s * v, y + s * u + c * v] for u, v in corners])


def turned(points: Array, origin: Array, yaw: float) -> Array:
    """Points in W (n, 2) seen from a pose (n, 2) [m]."""
    c, s = cos(yaw), sin(yaw)
    seen: Array = (points - origin) @ np.array([[c, -s], [s, c]])
    return seen


class WalkingFrame:
    """The robot's own frame without the sway: its pose averaged over one stride.

    Args:
        table: how it walked.
    """

    def __init__(self, table: WalkingTable) -> None:
        poses = _poses(table)
        width = min(_stride_rows(table), len(table))
        # The ends repeat the velocity there, so that the average does not lag.
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

    def seen(self, points: Array, rows: slice = slice(None)) -> Array:
        """Points in W as seen from the frames of some rows [m].

        Args:
            points: one a row (n, 2), or one for all of them (2,).
            rows: all by default.
        """
        dx, dy = (points - self._origin[rows]).T
        c, s = self._c[rows], self._s[rows]
        return np.column_stack([c * dx + s * dy, c * dy - s * dx])


def along(axes: Axes, table: WalkingTable, axis: int) -> None:
    """ZMP, CoM, DCM and soles along one axis of the walking robot over time.

    Args:
        axes: to draw into.
        table: how it walked.
        axis: 0 forward, 1 left.
    """
    frame = WalkingFrame(table)
    for foot, color in (("left", LEFT), ("right", RIGHT)):
        bands = []
        for first, last in contacts(table, foot):
            sole = outline(table, foot, (first, last))
            rows = slice(first, last + 1)
            corners = np.array([frame.seen(corner, rows)[:, axis] for corner in sole])
            upper = np.column_stack([table.time[rows], corners.max(axis=0)])
            lower = np.column_stack([table.time[rows], corners.min(axis=0)])
            bands.append(np.vstack([upper, lower[::-1]]))
        axes.add_collection(PolyCollection(bands, color=color, alpha=0.16, lw=0))
    for name, label, color, width, dash in CURVES:
        axes.plot(
            table.time,
            frame.seen(table.points(name))[:, axis],
            color=color,
            lw=width,
            ls=dash,
            label=label,
        )
    axes.set_ylabel(("forward\n[m]", "left\n[m]")[axis])
    if axis == 0:
        axes.set_title("seen from the body, without its sway", loc="left", fontsize="small")


def sole_legend() -> list[Patch]:
    """What the bands of `along` are."""
    return [
        Patch(color=LEFT, alpha=0.16, lw=0, label="left sole"),
        Patch(color=RIGHT, alpha=0.16, lw=0, label="right sole"),
    ]


def footsteps(axes: Axes, table: WalkingTable) -> None:
    """Where the feet stood, seen from above, with the ways of ZMP and CoM."""
    origin, yaw = table.points("robot")[0], float(table["robot_yaw"][0])
    for foot, color in (("left", LEFT), ("right", RIGHT)):
        stands = contacts(table, foot)
        soles = [turned(outline(table, foot, rows), origin, yaw) for rows in stands]
        axes.add_collection(PolyCollection(soles, fc=color, alpha=0.25, lw=0))
        axes.add_collection(PolyCollection(soles, fc="none", ec=color, lw=0.7))
    for name, label, color, width, dash in CURVES:
        if name in ("zmp", "cop", "com"):
            x, y = turned(table.points(name), origin, yaw).T
            axes.plot(x, y, color=color, lw=width, ls=dash, label=label)
    for row in _push_rows(table):
        at = turned(np.array([[table["push_x"][row], table["push_y"][row]]]), origin, yaw)[0]
        force = np.array([[table["push_fx"][row], table["push_fy"][row]]])
        way = turned(force, np.zeros(2), yaw)[0]
        way *= ARROW / np.hypot(*way)
        axes.update_datalim([at - way])
        axes.annotate(
            "",
            at,
            at - way,
            arrowprops={"arrowstyle": "-|>", "color": PUSH, "lw": 1.4, "shrinkA": 0, "shrinkB": 0},
        )
    axes.set_aspect("equal", adjustable="datalim")
    axes.autoscale_view()
    axes.set_xlabel("forward [m]")
    axes.set_ylabel("left [m]")


def velocity(axes: Axes, table: WalkingTable, component: int) -> None:
    """Velocity asked, given and achieved over one stride; component 0 vx, 1 vy, 2 wz."""
    name = ("vx", "vy", "wz")[component]
    axes.plot(table.time, table[f"commanded_{name}"], color=INK, lw=0.9, ls="--", label="commanded")
    axes.plot(table.time, table[f"applied_{name}"], color=ORANGE, lw=1.3, label="applied")
    time, achieved = achieved_velocity(table)
    if len(time):
        axes.plot(time, achieved[:, component], color=BLUE, lw=1.3, label="achieved")
    _at_least(axes, SPANS[component])
    axes.set_ylabel(("vx\n[m/s]", "vy\n[m/s]", "wz\n[rad/s]")[component])


def achieved_velocity(table: WalkingTable) -> tuple[Array, Array]:
    """Velocity of the robot over one stride each (n, 3), and the middle of that stride (n,) [s]."""
    width = _stride_rows(table)
    poses = _poses(table)
    period = float(np.median(np.diff(table.time)))
    starts = range(max(0, len(table) - width))
    rates = [mean_velocity(poses[k], poses[k + width], width * period) for k in starts]
    middle = np.array([0.5 * (table.time[k] + table.time[k + width]) for k in starts])
    return middle, np.array(rates).reshape(-1, 3)


def _poses(table: WalkingTable) -> Array:
    """True poses, the heading unwrapped (n, 3)."""
    yaw = np.unwrap(table["robot_yaw"])
    return np.column_stack([table["robot_x"], table["robot_y"], yaw])


def _stride_rows(table: WalkingTable) -> int:
    """Rows that one stride takes."""
    period = float(np.median(np.diff(table.time)))
    changes = table.time[np.flatnonzero(np.diff(table["steps"]) > 0)]
    stride = USUAL_STRIDE
    if len(changes) > STEPS_PER_STRIDE:
        stride = STEPS_PER_STRIDE * float(np.median(np.diff(changes)))
    return max(1, round(stride / period))


def _ramp(count: int, width: int) -> Array:
    """Shares of a stride at the `count` rows beyond the end (count, 1)."""
    return (np.arange(1, count + 1) / width)[:, None]


def _at_least(axes: Axes, span: float) -> None:
    """Widen what is shown along y to `span`, so that noise does not fill a panel."""
    low, high = axes.get_ylim()
    missing = max(0.0, span - (high - low))
    axes.set_ylim(low - 0.5 * missing, high + 0.5 * missing)


def torque(axes: Axes, table: WalkingTable, group: str) -> None:
    """Torques of one group of leg joints against their limits."""
    most = 0.0
    for joint, dash in zip(JOINTS[group], DASHES, strict=False):
        for side, color in (("l", LEFT), ("r", RIGHT)):
            name = f"{side}_{joint}"
            side_name = "left" if side == "l" else "right"
            label = f"{side_name} {joint.removeprefix(group + '_')}".replace("_", " ")
            axes.plot(
                table.time, table[f"torque_{name}"], color=color, lw=0.9, ls=dash, label=label
            )
            most = max(most, table.torque_limit[name])
    for limit in (-most, most):
        axes.axhline(limit, color=PUSH, lw=0.9, ls=(0, (6, 2)))
    axes.set_ylim(-1.12 * most, 1.12 * most)
    axes.set_ylabel(f"{group}\n[N m]")


def tilt(axes: Axes, table: WalkingTable) -> None:
    """Roll and pitch of the trunk as the robot measures them."""
    for name, color in (("roll", BLUE), ("pitch", ORANGE)):
        axes.plot(table.time, np.degrees(table[name]), color=color, lw=1.0, label=name)
    most = max(2.0, 1.15 * degrees(float(np.abs([table["roll"], table["pitch"]]).max())))
    axes.set_ylim(-most, most)
    axes.set_ylabel("trunk tilt\n[deg]")


def lanes(axes: Axes, table: WalkingTable) -> None:
    """Phase of the gait, and which constraints altered the command, over time."""
    end = table.time[-1] + float(np.median(np.diff(table.time)))
    phase = table["phase"].astype(int)
    for index, color in enumerate(LANES[p] for p in PHASES):
        axes.broken_barh(
            _runs(table.time, phase == index, end), (0.0, 0.8), color=color, alpha=0.75, lw=0
        )
    names = ["gait phase"]
    for limit, rows in table.active_limits().items():
        axes.broken_barh(_runs(table.time, rows, end), (len(names), 0.8), color=INK, lw=0)
        names.append(str(limit))
    axes.set_yticks([k + 0.4 for k in range(len(names))], names, fontsize="x-small")
    axes.set_ylim(len(names), -0.2)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False)


def lane_legend(table: WalkingTable) -> list[Patch]:
    """What the colours of the gait's lane are, falls only where there are any."""
    seen = {PHASES[int(index)] for index in np.unique(table["phase"])}
    return [
        Patch(color=LANES[p], alpha=0.75, lw=0, label=text)
        for p, text in PHASE_NAMES.items()
        if p in seen or not p.down
    ]


def mark_pushes(panels: Sequence[Axes], table: WalkingTable) -> None:
    """A line in every panel of time for every push."""
    for row in _push_rows(table):
        for axes in panels:
            axes.axvline(table["push_begin"][row], color=PUSH, lw=0.8, alpha=0.8, zorder=0)


def _push_rows(table: WalkingTable) -> list[int]:
    """First row of every push."""
    begins = np.where(table["push_impulse"] > 0.0, table["push_begin"], np.nan)
    new = ~np.isnan(begins) & (begins != np.concatenate([[np.nan], begins[:-1]]))
    rows: list[int] = np.flatnonzero(new).tolist()
    return rows


def _runs(time: Array, chosen: NDArray[np.bool_], end: float) -> list[tuple[float, float]]:
    """Beginning and length of every time in which rows are chosen [s]."""
    ends = np.append(time[1:], end)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], chosen.astype(int), [0]])))
    return [
        (float(time[a]), float(ends[b - 1] - time[a])) for a, b in edges.reshape(-1, 2).tolist()
    ]
