"""Calibration: what the loop needs to know about a robot, measured in simulation."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import pi

import numpy as np
from numpy.typing import NDArray

from hsr8.robots.loaded import LoadedRobot
from hsr8.trials.walk import Trial, Walked
from walking.command import HeadTarget, VelocityCommand
from walking.parameters import CONTROL_PERIOD, WalkingParameters

Array = NDArray[np.float64]
Report = Callable[[str], None]

AXES = ("vx", "vx_backward", "vy", "wz")
STEADY_TIME, RANDOM_TIME = 12.0, 60.0  # of a walk, in the time scale of HSR-VIII [s]
RANDOM_SEEDS = range(8)
MAX_ERROR = 0.05  # of a steady velocity, relative [1]
MAX_TILT = 8.0  # 99th percentile of the tilt in a steady walk [deg]
SHRINK = 0.85  # of a speed that failed
SLOW = 0.5  # of the rehearsed speed, below which a warning names the joint [1]
SMALLEST = 0.1  # of the rehearsed limit, below which an axis is given up [1]
STOPS, CORNERS = 0.15, 0.15  # fractions of random commands at rest and at the corners
HEAD_INTERVAL = 0.4  # between head targets [s]
LAGS = 40  # longest lag searched [ticks]
INTERVAL = 5.0  # over which the odometry drifts, for its noise [s]
FLOOR = 0.0002  # smallest odometry noise, as simulation knows no other ground [m/√s]


@dataclass(frozen=True, slots=True)
class Measured:
    """Result of a calibration; units as in `hsr8.robots.description.Calibration`."""

    speed: dict[str, float]
    turn_delay: float
    lag: float
    forward_noise: float
    lateral_noise: float
    tilt_sigma: float
    roll_sigma: float
    yaw_sigma: float
    height_sigma: float


@dataclass(frozen=True, slots=True)
class _Limit:
    """Largest speed along an axis, and the joint that limits it in words."""

    speed: float
    reason: str


def time_scale(parameters: WalkingParameters) -> float:
    """Return the time of a robot's walk relative to that of HSR-VIII [1]."""
    return parameters.gait.footstep_time / WalkingParameters().gait.footstep_time


def command_of(axis: str, speed: float) -> VelocityCommand:
    """Return the command along one axis of the speed limits."""
    sign = -1.0 if axis == "vx_backward" else 1.0
    name = axis.removesuffix("_backward")
    return VelocityCommand(**{name: sign * speed})


def random_commands(
    speed: dict[str, float],
    scale: float,
    seed: int,
    *,
    stops: float = STOPS,
    corners: float = CORNERS,
) -> Callable[[float], VelocityCommand]:
    """Return random commands within an envelope, by time.

    Args:
        speed: envelope.
        scale: scale of the time between changes, 0.5 to 2 s for HSR-VIII [1].
        seed: seed of the commands.
        stops: fraction of commands to stand [1].
        corners: fraction of commands with the maximum speed along every axis [1].
    """
    rng = np.random.default_rng([seed, 5])
    low = np.array([-speed["vx_backward"], -speed["vy"], -speed["wz"]])
    high = np.array([speed["vx"], speed["vy"], speed["wz"]])
    ends, commands = [0.0], []
    while ends[-1] < 3600.0:
        ends.append(ends[-1] + scale * float(rng.uniform(0.5, 2.0)))
        kind, drawn = float(rng.uniform()), rng.uniform(low, high)
        if kind < stops:
            drawn = np.zeros(3)
        elif kind < stops + corners:
            drawn = np.where(rng.uniform(size=3) < 0.5, low, high)
        commands.append(VelocityCommand(*drawn.tolist()))
    return lambda time: commands[int(np.searchsorted(ends, time, side="right")) - 1]


def random_head(robot: LoadedRobot, seed: int) -> Callable[[float], HeadTarget]:
    """Return random head targets within the range of the head, by time."""
    rng = np.random.default_rng([seed, 6])
    low, high = robot.model.neck.range().T
    low, high = np.maximum(low, (-0.5 * pi, -pi / 3.0)), np.minimum(high, (0.5 * pi, pi / 9.0))
    targets = [HeadTarget(*rng.uniform(low, np.maximum(low, high)).tolist()) for _ in range(9000)]
    return lambda time: targets[int(time / HEAD_INTERVAL)]


def calibrate(
    robot: LoadedRobot, report: Report = lambda _line: None
) -> tuple[Measured, list[str]]:
    """Measure a robot; return warnings of speeds far below the rehearsed ones, too.

    Args:
        robot: robot with its rehearsed limits.
        report: receives a line per result.
    """
    parameters = robot.parameters
    trial, scale = Trial(robot), time_scale(parameters)
    limits = {axis: _axis_limit(trial, axis, scale, report) for axis in AXES}
    speed = {axis: limit.speed for axis, limit in limits.items()}
    reasons = {axis: limit.reason for axis, limit in limits.items()}
    while True:
        trial.parameters = replace(parameters, limits=replace(parameters.limits, **speed))
        walks = list(_random_walks(trial, speed, scale))
        falls = sum(walk.falls for walk in walks)
        report(f"random commands in {_text(speed)}: {falls} falls in {len(walks)} walks")
        if not falls:
            break
        speed = {axis: SHRINK * value for axis, value in speed.items()}
        reasons = dict.fromkeys(AXES, walks[-1].limiting_joint(robot.model))
    warnings = [
        f"{axis}: {speed[axis] / top:.0%} of the rehearsed {top:.3g}: {reasons[axis]}"
        for axis in AXES
        if speed[axis] < SLOW * (top := float(getattr(parameters.limits, axis)))
    ]
    noise = _odometry_noise(walks)
    sigmas = np.sqrt(np.mean(np.concatenate([w.camera for w in walks]) ** 2, axis=0)).tolist()
    measured = Measured(
        speed={axis: _digits(value) for axis, value in speed.items()},
        turn_delay=_digits(_turn_delay(trial, speed["wz"], scale)),
        lag=_digits(float(np.mean([_lag(walk) for walk in walks]))),
        forward_noise=_digits(noise[0]),
        lateral_noise=_digits(noise[1]),
        tilt_sigma=_digits(sigmas[0]),
        roll_sigma=_digits(sigmas[1]),
        yaw_sigma=_digits(sigmas[2]),
        height_sigma=_digits(sigmas[3]),
    )
    return measured, warnings


def _axis_limit(trial: Trial, axis: str, scale: float, report: Report) -> _Limit:
    """Return the highest speed along an axis that a steady walk holds."""
    top: float = getattr(trial.parameters.limits, axis)
    speed, reason = float(top), ""
    while speed > SMALLEST * top:
        command = command_of(axis, speed)
        walk = trial.walk(command, scale * STEADY_TIME)
        error = np.abs(walk.velocity() - command.velocity).max() / speed
        tilt = float(np.percentile(walk.tilt, 99.0))
        held = not walk.falls and error <= MAX_ERROR and tilt <= MAX_TILT
        result = "falls" if walk.falls else f"error {error:.1%}, tilt {tilt:.1f} deg"
        report(f"{axis} {speed:.3f}: {result}")
        if held:
            break
        speed, reason = SHRINK * speed, walk.limiting_joint(trial.robot.model)
    return _Limit(speed, reason)


def _random_walks(trial: Trial, speed: dict[str, float], scale: float) -> Iterator[Walked]:
    """Yield walks under random commands, until one falls."""
    for seed in RANDOM_SEEDS:
        commands, head = random_commands(speed, scale, seed), random_head(trial.robot, seed)
        walk = trial.walk(commands, scale * RANDOM_TIME, seed, head=head)
        yield walk
        if walk.falls:
            return


def _turn_delay(trial: Trial, wz: float, scale: float) -> float:
    """Return the time from a commanded turn to half of its rate [s]."""
    start = 2.0 * scale
    walk = trial.walk(
        lambda time: VelocityCommand(wz=wz if time >= start else 0.0), start + 3.0 * scale
    )
    stride = 2 * round(trial.parameters.gait.footstep_time / CONTROL_PERIOD)
    turned = walk.poses[stride:, 2] - walk.poses[:-stride, 2]
    reached = np.flatnonzero(turned > 0.5 * wz * stride * CONTROL_PERIOD)
    first = float(reached[0]) if len(reached) else float(len(turned))
    return max(0.0, (first + 0.5 * stride) * CONTROL_PERIOD - start)


def _lag(walk: Walked) -> float:
    """Return the delay of the leg joints behind their targets [s]."""
    targets, angles = walk.targets[:, :12], walk.angles[:, :12]
    n = len(targets) - LAGS
    errors = [np.std(angles[k : k + n] - targets[:n]) for k in range(LAGS)]
    return int(np.argmin(errors)) * CONTROL_PERIOD


def _odometry_noise(walks: list[Walked]) -> tuple[float, float]:
    """Return the random walk of the odometry along and across the heading [m/√s]."""
    ticks, errors = round(INTERVAL / CONTROL_PERIOD), []
    for walk in walks:
        for begin in range(0, len(walk.poses) - ticks, ticks):
            true, believed = (
                _motion(poses[begin], poses[begin + ticks]) for poses in (walk.poses, walk.odometry)
            )
            errors.append(believed - true)
    forward, lateral = np.sqrt(np.mean(np.square(errors), axis=0) / INTERVAL).tolist()
    return max(FLOOR, forward), max(FLOOR, lateral)


def _motion(before: Array, after: Array) -> Array:
    """Return the displacement in the robot frame before (2,) [m]."""
    c, s = np.cos(before[2]), np.sin(before[2])
    dx, dy = after[:2] - before[:2]
    return np.array([c * dx + s * dy, c * dy - s * dx])


def _digits(value: float) -> float:
    return float(f"{value:.3g}")


def _text(speed: dict[str, float]) -> str:
    return ", ".join(f"{axis} {value:.3f}" for axis, value in speed.items())
