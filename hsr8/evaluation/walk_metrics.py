"""Results of walking: velocity against command, ZMP, altered commands, servos, time."""

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from hsr8.recorder.arc import mean_velocity
from hsr8.recorder.record import TickRecord
from hsr8.recorder.walk_counters import WalkCounters
from hsr8.world.truth.saturation import Saturation, SaturationWatch
from navigation.angles import wrap
from walking.body.joints import JOINT_NAMES
from walking.phase import Phase

Array = NDArray[np.float64]
Velocity = dict[str, float]

WARM_UP = 3.0  # velocities count from the first whole stride after this time [s]
STRIDE = 2  # footsteps after which the gait repeats
COMPONENTS = ("vx", "vy", "wz")


class Strides:
    """Sums over strides, each weighted by its duration.

    Attributes:
        time: of all of them [s].
        achieved: sum of the mean velocities in the robot frame (3,) [m, m, rad].
        errors: sums of what they were beyond the commanded and the applied velocity (3,).
        squares: sums of the squares of that (3,).
    """

    def __init__(self) -> None:
        self.time = 0.0
        self.achieved = np.zeros(3)
        self.errors = {name: np.zeros(3) for name in ("commanded", "applied")}
        self.squares = {name: np.zeros(3) for name in ("commanded", "applied")}

    def add(self, took: float, achieved: Array, **wanted: Array) -> None:
        """Take a stride: its duration [s] and its mean velocity (3,) [m/s, m/s, rad/s].

        ``commanded`` and ``applied`` are mean velocities over the stride, too.
        """
        self.time += took
        self.achieved += took * achieved
        for name, velocity in wanted.items():
            error = achieved - velocity
            self.errors[name] += took * error
            self.squares[name] += took * error**2


class StrideMeter:
    """Cuts a walk into strides and measures the velocity of each.

    At the same moment of every stride the sway of the body is the same, so that what is
    measured is the way alone. A robot that does not step is measured by the second.
    """

    def __init__(self) -> None:
        self.strides = Strides()
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
        stands = record.walking.phase is Phase.STANDING and time - self._begin[0] >= 1.0
        if steps - self._steps >= STRIDE or (stands and steps == self._steps):
            self._finish(time, pose)
            self._start(time, pose, steps)

    def interrupt(self) -> None:
        """What lies between the last record and the next one is no walk."""
        self._begin = self._last = None

    def _start(self, time: float, pose: Array, steps: int) -> None:
        self._begin, self._steps = (time, pose), steps
        self._commanded, self._applied = np.zeros(3), np.zeros(3)

    def _finish(self, time: float, pose: Array) -> None:
        assert self._begin is not None
        begin, start = self._begin
        took = time - begin
        self.strides.add(
            took,
            mean_velocity(start, pose, took),
            commanded=self._commanded / took,
            applied=self._applied / took,
        )


class WalkMetrics:
    """Computes the results of walking from the records of a run."""

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
        """All results by name.

        A body without dynamics has no servos to saturate, and its time is no measure: what is
        said of both is left out.
        """
        results: dict[str, object] = {"steps": self._steps, "pushes": self._pushes}
        results |= self._velocities()
        if self._counters is not None and self._counters.ticks:
            results |= _counted(self._counters)
        if self._saturation is not None:
            results |= _saturated(self._saturation.so_far())
            if self._counters is not None and self._counters.ticks:
                results |= _timed(self._counters)
        return results

    def _velocities(self) -> dict[str, object]:
        strides = self._meter.strides
        if not strides.time:
            return {"mean_velocity": None, "velocity_error": None, "velocity_error_rms": None}
        time = strides.time
        return {
            "mean_velocity": _named(strides.achieved / time),
            "velocity_error": {k: _named(e / time) for k, e in strides.errors.items()},
            "velocity_error_rms": {
                k: _named(np.sqrt(e / time)) for k, e in strides.squares.items()
            },
        }


def _named(velocity: Array) -> Velocity:
    return dict(zip(COMPONENTS, velocity.tolist(), strict=True))


def _counted(counters: WalkCounters) -> dict[str, object]:
    ticks = counters.ticks
    return {
        "walk_ticks": ticks,
        "zmp_outside_sole_ticks": counters.zmp_outside,
        "zmp_least_margin_m": counters.min_zmp_depth if isfinite(counters.min_zmp_depth) else None,
        "altered_commands": counters.limited / ticks,
        "altered_by": {
            limit.value.replace(" ", "_"): count / ticks
            for limit, count in counters.by_limit.most_common()
        },
    }


def _timed(counters: WalkCounters) -> dict[str, object]:
    wall = counters.wall_times
    return {
        "walk_tick_mean_ms": 1000.0 * wall.mean,
        "walk_tick_p999_ms": 1000.0 * wall.quantile(0.999),
        "walk_tick_max_ms": 1000.0 * wall.max,
    }


def _saturated(saturation: Saturation) -> dict[str, object]:
    strongest = int(np.argmax(saturation.peak_torque))
    fastest = int(np.argmax(saturation.peak_speed))
    return {
        "torque_saturated_ticks": saturation.torque_any,
        "torque_saturated_by": _by_joint(saturation.torque_ticks),
        "joint_stop_ticks": saturation.stop_any,
        "joint_stop_by": _by_joint(saturation.stop_ticks),
        "clipped_target_ticks": saturation.clip_any,
        "clipped_target_by": _by_joint(saturation.clip_ticks),
        "peak_torque_share": float(saturation.peak_torque[strongest]),
        "peak_torque_joint": JOINT_NAMES[strongest],
        "peak_joint_speed_radps": float(saturation.peak_speed[fastest]),
        "peak_speed_joint": JOINT_NAMES[fastest],
    }


def _by_joint(ticks: NDArray[np.int64]) -> dict[str, int]:
    return {name: n for name, n in zip(JOINT_NAMES, ticks.tolist(), strict=True) if n}
