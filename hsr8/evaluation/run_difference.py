"""Differences between two runs: the first tick, channel and values of every record."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import zip_longest
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.fingerprints import CHANNELS, DECISIONS
from hsr8.recorder.run.measurements import Measurement
from hsr8.recorder.run.run_reader import Run
from hsr8.recorder.run.tape import Block
from hsr8.robots.loaded import LoadedRobot, load_robot
from walking.parameters import CONTROL_PERIOD

Array = NDArray[np.float64]

RECORDS = ("tape", "trajectory", "measurements", "walking", "frames", "events")
CLOCKED = ("wall_time_s", "real_time_factor", "walk_tick_")  # results of the wall clock
ROOT = ("x", "y", "z", "qw", "qx", "qy", "qz")


@dataclass(frozen=True, slots=True)
class RunDifference:
    """The first difference in one record of two runs.

    Attributes:
        record: file, or ``settings`` and ``results``.
        channel: quantity that differs.
        a, b: the two values; None if a run lacks the value.
        tick: control tick, None without a time.
        time: simulated time [s].
    """

    record: str
    channel: str
    a: Any
    b: Any
    tick: int | None = None
    time: float | None = None


def settings(a: Run, b: Run) -> Iterator[RunDifference]:
    """Yield every key of the scenario that differs."""
    for key, x, y in _unequal(_flat(_scenario(a)), _flat(_scenario(b))):
        yield RunDifference("settings", key, x, y)


def results(a: Run, b: Run) -> Iterator[RunDifference]:
    """Yield every result that differs, except those of the wall clock."""
    for key, x, y in _unequal(_flat(a.metrics()), _flat(b.metrics())):
        if not key.startswith(CLOCKED):
            yield RunDifference("results", key, x, y)


def motion(a: Run, b: Run) -> list[RunDifference]:
    """Return the first difference of every record, the earliest first.

    Raises:
        UsageError: a record is missing, damaged or, in a run that ended, cut off.
    """
    tapes = a.tape(), b.tape()
    inputs = ([(m.frame.time, _values(m)) for m in run.measurements()] for run in (a, b))
    summaries = ([(frame.time, asdict(frame)) for frame in run.frame_summaries()] for run in (a, b))
    differences = (
        _first_set_point(a, *tapes),
        _first_hash(*tapes),
        _first_row(a, b),
        _first_frame("measurements", *inputs),
        _first_walking(a, b),
        _first_frame("frames", *summaries),
        _first_event(a, b),
    )
    present = [difference for difference in differences if difference is not None]
    return sorted(present, key=lambda difference: difference.tick or 0)


def _first_set_point(run: Run, a: list[Block], b: list[Block]) -> RunDifference | None:
    joints = [{block.setpoints.shape[1] for block in tape} or {0} for tape in (a, b)]
    if joints[0] != joints[1]:
        x, y = (max(n) for n in joints)
        return RunDifference("tape", "number of joints", x, y, 0, 0.0)
    none = np.empty((0, max(joints[0])))
    rows = [np.concatenate([none, *(block.setpoints for block in tape)]) for tape in (a, b)]
    n = min(map(len, rows))
    differ = rows[0][:n].view(np.int64) != rows[1][:n].view(np.int64)
    ticks = np.flatnonzero(differ.any(axis=1))
    if len(ticks):
        tick = int(ticks[0])
        joint = int(np.argmax(differ[tick]))
        x, y = (float(table[tick, joint]) for table in rows)
        channel = f"setpoint of {_robot(run).model.names[joint]} [rad]"
        return RunDifference("tape", channel, x, y, tick, tick * CONTROL_PERIOD)
    if len(rows[0]) != len(rows[1]):
        x, y = map(len, rows)
        return RunDifference("tape", "number of ticks", x, y, n, n * CONTROL_PERIOD)
    return None


def _first_hash(a: list[Block], b: list[Block]) -> RunDifference | None:
    for x, y in zip(a, b, strict=False):
        for channel in ("world", "robot"):
            if x.tick == y.tick and getattr(x, channel) != getattr(y, channel):
                values = getattr(x, channel), getattr(y, channel)
                name = f"hash of {'the world' if channel == 'world' else 'world and belief'}"
                return RunDifference("tape", name, *values, x.tick, x.tick * CONTROL_PERIOD)
    return _longer(
        "tape", "hashes", *([block.tick * CONTROL_PERIOD for block in tape] for tape in (a, b))
    )


def _first_row(a: Run, b: Run) -> RunDifference | None:
    p, q = a.trajectory(), b.trajectory()
    if p.qpos.shape[1] != q.qpos.shape[1] or p.movers.shape[1] != q.movers.shape[1]:
        shapes = [f"{t.qpos.shape[1]} coordinates, {t.movers.shape[1]} movers" for t in (p, q)]
        return RunDifference("trajectory", "columns", shapes[0], shapes[1], 0, 0.0)
    names = ["time [s]", *_qpos_names(_robot(a), p.qpos.shape[1])]
    names += [f"mover {k // 2} {'xy'[k % 2]} [m]" for k in range(2 * p.movers.shape[1])]
    tables = [np.hstack([t.time[:, None], t.qpos, t.movers.reshape(len(t), -1)]) for t in (p, q)]
    return _first_value("trajectory", names, *tables)


def _first_walking(a: Run, b: Run) -> RunDifference | None:
    walks = a.walking(), b.walking()
    tables = [np.column_stack([t.time, *t.columns.values()]) for t in walks]
    return _first_value("walking", ["time [s]", *walks[0].columns], *tables)


def _first_value(record: str, names: Sequence[str], a: Array, b: Array) -> RunDifference | None:
    """Compare two tables (n, columns) with the time in the first column."""
    n = min(len(a), len(b))
    bits = [np.ascontiguousarray(table[:n]).view(np.int64) for table in (a, b)]
    differ = bits[0] != bits[1]
    rows = np.flatnonzero(differ.any(axis=1))
    if not len(rows):
        return _longer(record, "rows", a[:, 0].tolist(), b[:, 0].tolist())
    row = int(rows[0])
    column = int(np.argmax(differ[row]))
    x, y, time = float(a[row, column]), float(b[row, column]), float(a[row, 0])
    return RunDifference(record, names[column], x, y, round(time / CONTROL_PERIOD), time)


def _longer(record: str, unit: str, a: Sequence[float], b: Sequence[float]) -> RunDifference | None:
    """Compare the lengths of two otherwise equal records, given their times [s]."""
    if len(a) == len(b):
        return None
    time = max(a, b, key=len)[min(len(a), len(b))]
    tick = round(time / CONTROL_PERIOD)
    return RunDifference(record, f"number of {unit}", len(a), len(b), tick, time)


def _first_frame(
    record: str, a: list[tuple[float, dict[str, Any]]], b: list[tuple[float, dict[str, Any]]]
) -> RunDifference | None:
    """Compare two records of frames, each with its time [s] and values by channel."""
    for index, ((time, x), (_, y)) in enumerate(zip(a, b, strict=False)):
        for channel, u, v in _unequal(x, y):
            name = f"{channel}, frame {index}"
            return RunDifference(record, name, u, v, round(time / CONTROL_PERIOD), time)
    return _longer(record, "frames", *([time for time, _ in frames] for frames in (a, b)))


def _first_event(a: Run, b: Run) -> RunDifference | None:
    for index, (x, y) in enumerate(zip_longest(a.event_lines(), b.event_lines(), fillvalue=None)):
        for channel, u, v in _unequal(x or {}, y or {}):
            if channel == "time" and None in (x, y):
                continue  # the text names the missing event
            time = min(float(event["time"]) for event in (x, y) if event is not None)
            name = f"{channel} of event {index}"
            return RunDifference("events", name, u, v, round(time / CONTROL_PERIOD), time)
    return None


def _values(measurement: Measurement) -> dict[str, Any]:
    """Return all values of a frame by name, in the order of their computation."""
    frame = measurement.frame
    values: dict[str, Any] = {"time [s]": frame.time}
    for name, array in (
        ("odometry [m, m, rad]", frame.odometry),
        ("covariance of the odometry", frame.motion_covariance),
        ("position of the camera [m]", frame.view.position),
        ("attitude of the camera", frame.view.rotation),
    ):
        values |= {f"{name} {k}": value for k, value in enumerate(array.ravel().tolist())}
    values["number of observations"] = len(frame.observations)
    for k, observation in enumerate(frame.observations):
        name = f"observation {k}"
        values |= {f"{name}: kind": observation.kind, f"{name}: label": observation.label}
        values |= {
            f"{name}: distance [m]": observation.distance,
            f"{name}: bearing [rad]": observation.bearing,
        }
        values[f"{name}: covariance"] = observation.covariance.tolist()
    for kind, names, prints in (
        ("belief", CHANNELS, measurement.fingerprints),
        ("decision", DECISIONS, measurement.decision),
    ):
        values |= {f"{kind}: {n}": p.hex() for n, p in zip(names, prints, strict=True)}
    return values


def _robot(run: Run) -> LoadedRobot:
    return load_robot(run.scenario().robot.model)


def _qpos_names(robot: LoadedRobot, count: int) -> list[str]:
    """Return the name of every coordinate of a robot in MuJoCo's order."""
    model = robot.spec.copy().compile()
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
        return tomllib.loads(run.scenario_text())
    except (ValueError, RecursionError) as error:
        raise UsageError(f"cannot read {run.scenario_file}: {error}") from error


def _flat(value: Any, key: str = "") -> dict[str, Any]:
    """Return every leaf by its dotted key."""
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
