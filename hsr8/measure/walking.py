"""Metrics of walking: velocity tracking, ZMP, limited commands, servos, computing time."""

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from hsr8.recording.derived import mean_velocity, strides
from hsr8.recording.rows import BITS
from hsr8.recording.run import Run
from hsr8.recording.table import Table
from navigation.angles import wrap
from walking.state import Phase

Array = NDArray[np.float64]

WARM_UP = 3.0  # velocities count from the first whole stride after this time [s]
COMPONENTS = ("vx", "vy", "wz")
REFERENCES = {"commanded": "command", "applied": "applied_velocity"}
DOWN = [phase.value for phase in Phase if phase.down]
ROUNDING = 1e-9  # of a ZMP on the edge of the sole [m]


def walk_metrics(run: Run) -> dict[str, object]:
    """Return the results of walking by name.

    A kinematic body has no servos and its computing time is not representative: results of both are
    left out.
    """
    records, ticks, seconds = run.records, run.ticks, run.seconds
    results: dict[str, object] = {
        "steps": int(records["step_count"][-1]) if len(records) else 0,
        "pushes": int(np.max(records["pushes"]["number"] + 1, initial=0)),
    }
    results |= stride_velocities(records)
    walking = ~ticks["down"]
    if walking.any():
        results |= _counts(ticks["limits"][walking], ticks["zmp_depth"][walking])
    if len(seconds.present("peak_torque")[0]):
        results |= _saturation(seconds)
        if walking.any():
            results |= _times(ticks["walking_time"][walking])
    return results


def stride_velocities(records: Table) -> dict[str, object]:
    """Compare mean velocities over whole strides with the commanded and the applied velocity.

    The body sways equally at the same phase of every stride, so that sway cancels. Without
    footsteps, intervals of one second take the place of strides. Means are weighted by duration.

    Returns:
        Mean velocity, signed and root mean square error; None without a whole stride.
    """
    down = records["fallen"] | np.isin(records["phase"], DOWN)
    whole = strides(records, down, WARM_UP)
    if not whole:
        return {"mean_velocity": None, "velocity_error": None, "velocity_error_rms": None}
    poses = records["robot"].copy()
    poses[~down, 2] = _unwrapped(poses[~down, 2])
    time = records["time"]
    elapsed = np.diff(time)[:, None]
    begins, ends = np.transpose(whole)
    duration = (time[ends] - time[begins])[:, None]
    achieved = np.array([mean_velocity(poses[a], poses[b], time[b] - time[a]) for a, b in whole])
    errors = {}
    for name, column in REFERENCES.items():
        velocity = records[column]
        moved = [np.cumsum(elapsed[a:b] * velocity[a:b], axis=0)[-1] for a, b in whole]
        errors[name] = achieved - moved / duration

    def weighted(values: Array) -> Array:
        mean: Array = np.cumsum(duration * values, axis=0)[-1] / np.cumsum(duration)[-1]
        return mean

    return {
        "mean_velocity": _named(weighted(achieved)),
        "velocity_error": {k: _named(weighted(error)) for k, error in errors.items()},
        "velocity_error_rms": {
            k: _named(np.sqrt(weighted(error**2))) for k, error in errors.items()
        },
    }


def _unwrapped(angles: Array) -> list[float]:
    """Return angles (n,) [rad] without jumps."""
    angle, unwrapped = 0.0, []
    for wrapped in angles.tolist():
        angle += wrap(wrapped - angle)
        unwrapped.append(angle)
    return unwrapped


def _named(velocity: Array) -> dict[str, float]:
    return dict(zip(COMPONENTS, velocity.tolist(), strict=True))


def _counts(limits: NDArray[np.int64], zmp_depth: Array) -> dict[str, object]:
    n, depth = len(limits), float(np.fmin.reduce(zmp_depth))
    counts = {limit: int(np.count_nonzero(limits & bit)) for limit, bit in BITS.items()}
    return {
        "walk_ticks": n,
        "zmp_outside_sole_ticks": int(np.count_nonzero(zmp_depth < -ROUNDING)),
        "zmp_min_margin_m": depth if isfinite(depth) else None,
        "limited_fraction": int(np.count_nonzero(limits)) / n,
        "limited_by": {
            limit.value.replace(" ", "_"): count / n
            for limit, count in sorted(counts.items(), key=lambda item: -item[1])
            if count
        },
    }


def _times(seconds: Array) -> dict[str, object]:
    times = 1000.0 * seconds
    return {
        "walk_tick_mean_ms": float(times.mean()),
        "walk_tick_p999_ms": float(np.quantile(times, 0.999)),
        "walk_tick_max_ms": float(times.max()),
    }


def _saturation(seconds: Table) -> dict[str, object]:
    names = seconds.names("peak_torque")
    torque, speed = seconds["peak_torque"][-1], seconds["peak_speed"][-1]
    strongest, fastest = int(np.argmax(torque)), int(np.argmax(speed))
    return {
        "torque_saturated_ticks": int(seconds["torque_saturated"][-1]),
        "torque_saturated_by": _by_joint(names, seconds["torque_saturated_by"][-1]),
        "joint_stop_ticks": int(seconds["at_stop"][-1]),
        "joint_stop_by": _by_joint(names, seconds["at_stop_by"][-1]),
        "peak_torque_ratio": float(torque[strongest]),
        "peak_torque_joint": names[strongest],
        "peak_joint_speed_radps": float(speed[fastest]),
        "peak_speed_joint": names[fastest],
    }


def _by_joint(names: tuple[str, ...], ticks: NDArray[np.int64]) -> dict[str, int]:
    return {name: n for name, n in zip(names, ticks.tolist(), strict=True) if n}
