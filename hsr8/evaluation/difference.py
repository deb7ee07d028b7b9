"""Where two runs part: the first tick, channel and values that differ."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder import run_folder
from hsr8.recorder.fingerprints import CHANNELS, DECISIONS
from hsr8.recorder.measurements import Measured, read_measurements
from hsr8.recorder.run_reader import Run
from hsr8.recorder.tape import Block, read_tape
from hsr8.world.model.models import models_dir
from walking.body.joints import JOINT_NAMES
from walking.parameters import CONTROL_PERIOD

Array = NDArray[np.float64]

# Results that depend on the machine and its load.
CLOCKED = ("wall_time_s", "real_time_factor", "walk_tick_")
ROOT = ("x", "y", "z", "qw", "qx", "qy", "qz")


@dataclass(frozen=True, slots=True)
class Difference:
    """The first difference in one record of two runs.

    Attributes:
        record: file, or ``settings`` and ``results``.
        channel: what differs in it.
        a, b: the two values; None where one run has none.
        tick: control tick, None where there is no time.
        time: simulated time [s].
    """

    record: str
    channel: str
    a: Any
    b: Any
    tick: int | None = None
    time: float | None = None


def settings(a: Run, b: Run) -> Iterator[Difference]:
    """Every key of the scenario that differs."""
    for key, x, y in _unequal(_flat(_scenario(a)), _flat(_scenario(b))):
        yield Difference("settings", key, x, y)


def results(a: Run, b: Run) -> Iterator[Difference]:
    """Every result that differs, but those of the clock on the wall."""
    for key, x, y in _unequal(_flat(a.metrics()), _flat(b.metrics())):
        if not key.startswith(CLOCKED):
            yield Difference("results", key, x, y)


def motion(a: Run, b: Run) -> list[Difference]:
    """The first difference of every record of what happened, the earliest first.

    Raises:
        UsageError: a record is missing or damaged.
    """
    found = (
        _first_set_point(*(_tape(run) for run in (a, b))),
        _first_hash(*(_tape(run) for run in (a, b))),
        _first_row(a, b),
        _first_frame(*(_measured(run) for run in (a, b))),
    )
    told = [difference for difference in found if difference is not None]
    return sorted(told, key=lambda difference: difference.tick or 0)


def _first_set_point(a: list[Block], b: list[Block]) -> Difference | None:
    none = np.empty((0, len(JOINT_NAMES)))
    rows = [np.concatenate([none, *(block.set_points for block in tape)]) for tape in (a, b)]
    n = min(map(len, rows))
    differ = rows[0][:n].view(np.int64) != rows[1][:n].view(np.int64)
    ticks = np.flatnonzero(differ.any(axis=1))
    if len(ticks):
        tick = int(ticks[0])
        joint = int(np.argmax(differ[tick]))
        x, y = (float(table[tick, joint]) for table in rows)
        channel = f"set-point of {JOINT_NAMES[joint]} [rad]"
        return Difference("tape", channel, x, y, tick, tick * CONTROL_PERIOD)
    if len(rows[0]) != len(rows[1]):
        x, y = map(len, rows)
        return Difference("tape", "number of ticks", x, y, n, n * CONTROL_PERIOD)
    return None


def _first_hash(a: list[Block], b: list[Block]) -> Difference | None:
    for x, y in zip(a, b, strict=False):
        for channel in ("world", "robot"):
            if x.tick == y.tick and getattr(x, channel) != getattr(y, channel):
                values = getattr(x, channel), getattr(y, channel)
                name = f"hash of {'the world' if channel == 'world' else 'world and belief'}"
                return Difference("tape", name, *values, x.tick, x.tick * CONTROL_PERIOD)
    return None


def _first_row(a: Run, b: Run) -> Difference | None:
    p, q = a.trajectory(), b.trajectory()
    n = min(len(p), len(q))
    if p.qpos.shape[1] != q.qpos.shape[1] or p.movers.shape[1] != q.movers.shape[1]:
        shapes = [f"{t.qpos.shape[1]} coordinates, {t.movers.shape[1]} movers" for t in (p, q)]
        return Difference("trajectory", "columns", shapes[0], shapes[1], 0, 0.0)
    tables = [
        np.hstack([t.time[:n, None], t.qpos[:n], t.movers[:n].reshape(n, -1)]) for t in (p, q)
    ]
    differ = tables[0].view(np.int64) != tables[1].view(np.int64)
    rows = np.flatnonzero(differ.any(axis=1))
    if not len(rows):
        return None
    row = int(rows[0])
    column = int(np.argmax(differ[row]))
    names = ["time [s]", *_qpos_names(p.qpos.shape[1])]
    names += [f"mover {k // 2} {'xy'[k % 2]} [m]" for k in range(2 * p.movers.shape[1])]
    x, y = (float(table[row, column]) for table in tables)
    time = float(p.time[row])
    return Difference("trajectory", names[column], x, y, round(time / CONTROL_PERIOD), time)


def _first_frame(a: list[Measured], b: list[Measured]) -> Difference | None:
    for index, (x, y) in enumerate(zip(a, b, strict=False)):
        for channel, u, v in _unequal(_values(x), _values(y)):
            tick = round(x.frame.time / CONTROL_PERIOD)
            name = f"{channel}, frame {index}"
            return Difference("measurements", name, u, v, tick, x.frame.time)
    return None


def _values(measured: Measured) -> dict[str, Any]:
    """Everything of a frame by its name, in the order in which it came about."""
    frame = measured.frame
    values: dict[str, Any] = {"time [s]": frame.time}
    for name, array in (
        ("odometry [m, m, rad]", frame.odometry),
        ("covariance of the odometry", frame.motion_covariance),
        ("place of the camera [m]", frame.view.position),
        ("attitude of the camera", frame.view.rotation),
    ):
        values |= {f"{name} {k}": value for k, value in enumerate(array.ravel().tolist())}
    values["number of observations"] = len(frame.observations)
    for k, seen in enumerate(frame.observations):
        what = f"observation {k}"
        values |= {f"{what}: kind": seen.kind, f"{what}: label": seen.label}
        values |= {f"{what}: distance [m]": seen.distance, f"{what}: bearing [rad]": seen.bearing}
        values[f"{what}: covariance"] = seen.covariance.tolist()
    for kind, names, prints in (
        ("belief", CHANNELS, measured.fingerprints),
        ("decision", DECISIONS, measured.decided),
    ):
        values |= {f"{kind}: {n}": p.hex() for n, p in zip(names, prints, strict=True)}
    return values


def _tape(run: Run) -> list[Block]:
    return read_tape(run.path / run_folder.TAPE, whole=False)


def _measured(run: Run) -> list[Measured]:
    return read_measurements(run.path / run_folder.MEASUREMENTS, whole=False)


def _qpos_names(count: int) -> list[str]:
    """Name of every coordinate of the robot, in MuJoCo's order."""
    model = mujoco.MjModel.from_xml_path(str(models_dir() / "hsr8" / "hsr8.xml"))
    names = [f"qpos[{k}]" for k in range(count)]
    for k in range(model.njnt):
        joint = model.joint(k)
        address = int(joint.qposadr[0])
        for offset, part in enumerate(ROOT if joint.type[0] == 0 else ("angle [rad]",)):
            if address + offset < count:
                names[address + offset] = f"{joint.name} {part}"
    return names


def _scenario(run: Run) -> Mapping[str, Any]:
    try:
        with run.scenario_file.open("rb") as file:
            return tomllib.load(file)
    except (OSError, ValueError) as error:
        raise UsageError(f"cannot read {run.scenario_file}: {error}") from error


def _flat(value: Any, key: str = "") -> dict[str, Any]:
    """Every leaf by its dotted key."""
    if isinstance(value, Mapping):
        inner: Sequence[tuple[str, Any]] = list(value.items())
    elif isinstance(value, list):
        inner = [(str(k), item) for k, item in enumerate(value)]
    else:
        return {key: value}
    leaves: dict[str, Any] = {}
    for name, item in inner:
        leaves |= _flat(item, f"{key}.{name}" if key else name)
    return leaves


def _unequal(a: Mapping[str, Any], b: Mapping[str, Any]) -> Iterator[tuple[str, Any, Any]]:
    for key in [*a, *(key for key in b if key not in a)]:
        if a.get(key) != b.get(key):
            yield key, a.get(key), b.get(key)
