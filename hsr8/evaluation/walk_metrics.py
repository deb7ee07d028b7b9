"""Results of walking: velocity tracking, ZMP, limited commands, servos, computing time."""

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from hsr8.record import TickRecord
from hsr8.recorder.arc import mean_velocity
from hsr8.walk_counters import WalkCounters
from hsr8.world.truth.saturation import Saturation, SaturationWatch
from navigation.angles import wrap
from walking.phase import Phase

Array = NDArray[np.float64]

WARM_UP = 3.0  # velocities count from the first whole stride after this time [s]
STRIDE = 2  # footsteps after which the gait repeats
COMPONENTS = ("vx", "vy", "wz")
REFERENCES = ("commanded", "applied")


class StrideMeter:
    """Mean velocity over whole strides, compared with the commanded and the applied velocity.

    The body sways equally at the same phase of every stride, so that sway cancels. Without
    footsteps, intervals of one second take the place of strides. Sums are weighted by duration.

    Attributes:
        time: duration of all strides [s].
        achieved: sum of the mean velocities in the robot frame (3,) [m, m, rad].
        errors: sums of the error with respect to each of `REFERENCES` (3,).
        squares: sums of the squared errors (3,).
    """

    def __init__(self) -> None:
        self.time = 0.0
        self.achieved = np.zeros(3)
        self.errors = {name: np.zeros(3) for name in REFERENCES}
        self.squares = {name: np.zeros(3) for name in REFERENCES}
        self._begin: tuple[float, Array] | None = None
        self._steps = 0
        self._yaw = 0.0
        self._last: tuple[float, Array, Array] | None = None
        self._commanded, self._applied = np.zeros(3), np.zeros(3)

    def add(self, record: TickRecord) -> None:
        """Take one record."""
        time, steps = record.time, record.walking.step_count
        x, y, yaw = record.truth.robot.tolist()
        self._yaw += wrap(yaw - self._yaw)
        pose = np.array([x, y, self._yaw])
        if self._last is not None:
            elapsed = time - self._last[0]
            self._commanded += elapsed * self._last[1]
            self._applied += elapsed * self._last[2]
        self._last = (time, np.array(record.command.velocity), record.walking.applied_velocity)
        if time < WARM_UP:
            self._steps = steps
            return
        if self._begin is None:
            if steps != self._steps or record.walking.phase is Phase.STANDING:
                self._start(time, pose, steps)
            return
        standing = record.walking.phase is Phase.STANDING and time - self._begin[0] >= 1.0
        if steps - self._steps >= STRIDE or (standing and steps == self._steps):
            self._finish(time, pose)
            self._start(time, pose, steps)

    def interrupt(self) -> None:
        """Discard the current stride, because the robot is down."""
        self._begin = self._last = None

    def _start(self, time: float, pose: Array, steps: int) -> None:
        self._begin, self._steps = (time, pose), steps
        self._commanded, self._applied = np.zeros(3), np.zeros(3)

    def _finish(self, time: float, pose: Array) -> None:
        assert self._begin is not None
        begin, start = self._begin
        duration = time - begin
        achieved = mean_velocity(start, pose, duration)
        self.time += duration
        self.achieved += duration * achieved
        for name, integral in zip(REFERENCES, (self._commanded, self._applied), strict=True):
            error = achieved - integral / duration
            self.errors[name] += duration * error
            self.squares[name] += duration * error**2


class WalkMetrics:
    """Results of walking, computed from the records of a run."""

    def __init__(self) -> None:
        self._meter = StrideMeter()
        self._steps = 0
        self._counters: WalkCounters | None = None
        self._saturation: SaturationWatch | None = None
        self._pushes = 0

    def add(self, record: TickRecord) -> None:
        """Take one record."""
        if record.truth.fallen or record.walking.phase.down:
            self._meter.interrupt()
        else:
            self._meter.add(record)
        self._steps = record.walking.step_count
        self._counters = record.counters
        self._saturation = record.truth.saturation
        for push in record.truth.pushes:
            self._pushes = max(self._pushes, push.number + 1)

    def result(self) -> dict[str, object]:
        """Return all results by name.

        A kinematic body has no servos and its computing time is not representative: results of
        both are left out.
        """
        results: dict[str, object] = {"steps": self._steps, "pushes": self._pushes}
        results |= self._velocities()
        counters = self._counters if self._counters and self._counters.ticks else None
        if counters is not None:
            results |= _counts(counters)
        if self._saturation is not None:
            results |= _saturation(self._saturation.so_far())
            if counters is not None:
                results |= _times(counters)
        return results

    def _velocities(self) -> dict[str, object]:
        meter = self._meter
        if not meter.time:
            return {"mean_velocity": None, "velocity_error": None, "velocity_error_rms": None}
        time = meter.time
        return {
            "mean_velocity": _named(meter.achieved / time),
            "velocity_error": {k: _named(e / time) for k, e in meter.errors.items()},
            "velocity_error_rms": {k: _named(np.sqrt(e / time)) for k, e in meter.squares.items()},
        }


def _named(velocity: Array) -> dict[str, float]:
    return dict(zip(COMPONENTS, velocity.tolist(), strict=True))


def _counts(counters: WalkCounters) -> dict[str, object]:
    ticks, depth = counters.ticks, counters.min_zmp_depth
    return {
        "walk_ticks": ticks,
        "zmp_outside_sole_ticks": counters.zmp_outside,
        "zmp_min_margin_m": depth if isfinite(depth) else None,
        "limited_fraction": counters.limited / ticks,
        "limited_by": {
            limit.value.replace(" ", "_"): count / ticks
            for limit, count in counters.by_limit.most_common()
        },
    }


def _times(counters: WalkCounters) -> dict[str, object]:
    times = 1000.0 * np.array(counters.wall_times)
    return {
        "walk_tick_mean_ms": float(times.mean()),
        "walk_tick_p999_ms": float(np.quantile(times, 0.999)),
        "walk_tick_max_ms": float(times.max()),
    }


def _saturation(saturation: Saturation) -> dict[str, object]:
    strongest = int(np.argmax(saturation.peak_torque))
    fastest = int(np.argmax(saturation.peak_speed))
    return {
        "torque_saturated_ticks": saturation.torque_any,
        "torque_saturated_by": _by_joint(saturation.names, saturation.torque_ticks),
        "joint_stop_ticks": saturation.stop_any,
        "joint_stop_by": _by_joint(saturation.names, saturation.stop_ticks),
        "peak_torque_ratio": float(saturation.peak_torque[strongest]),
        "peak_torque_joint": saturation.names[strongest],
        "peak_joint_speed_radps": float(saturation.peak_speed[fastest]),
        "peak_speed_joint": saturation.names[fastest],
    }


def _by_joint(names: tuple[str, ...], ticks: NDArray[np.int64]) -> dict[str, int]:
    return {name: n for name, n in zip(names, ticks.tolist(), strict=True) if n}
