"""Calibration: what the loop needs to know about a robot, measured in simulation."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.file.description import MIN_SPEED
from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.walk.rehearsal import AXES, command_of
from hsr8.trials.commands import random_commands, random_head, time_scale
from hsr8.trials.robot_check import MAX_TILT, check_robot
from hsr8.trials.walk import Trial, Walked
from walking.command import VelocityCommand
from walking.parameters import CONTROL_PERIOD

Array = NDArray[np.float64]
Report = Callable[[str], None]

STEADY_TIME, RANDOM_TIME = 12.0, 60.0  # of a walk, in the time scale of HSR-VIII [s]
RANDOM_SEEDS = range(8)
MAX_ERROR = 0.05  # of a steady velocity, relative [1]
SHRINK = 0.85  # of a speed that failed
NARROW = 0.5  # lateral reach of a robot that falls at its speeds, of that by rule [1]
SLOW = 0.5  # of the rehearsed speed, below which a warning names the joint [1]
SMALLEST = 0.1  # of the rehearsed limit, below which an axis is given up [1]
LAGS = 40  # longest lag searched [ticks]
INTERVAL = 5.0  # over which the odometry drifts, for its noise [s]
FLOOR = 0.0002  # smallest odometry noise, as simulation knows no other ground [m/√s]


@dataclass(frozen=True, slots=True)
class Measured:
    """Result of a calibration; units as in `hsr8.robots.file.description.Calibration`."""

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


def calibrate(
    robot: LoadedRobot, report: Report = lambda _line: None
) -> tuple[Measured, list[str]]:
    """Measure a robot; return warnings of speeds far below the rehearsed ones, too.

    Until the robot walks under random commands and passes its check, first the combination of
    speeds along several axes is reduced, then every speed; each is tried with a narrower lateral
    reach of capture steps, too, since heavy legs that swing far push the robot over.

    Args:
        robot: robot with its rehearsed limits.
        report: receives a line per result.

    Raises:
        ModelError: the robot would be too slow for navigation.
    """
    parameters = robot.parameters
    trial, scale = Trial(robot), time_scale(parameters)
    limits = {axis: _axis_limit(trial, axis, scale, report) for axis in AXES}
    speed = {axis: _digits(limit.speed) for axis, limit in limits.items()}
    reasons = {axis: limit.reason for axis, limit in limits.items()}
    combined, reach = parameters.limits.combined, 1.0
    while True:
        _require_speed(robot, speed, reasons)
        side = reach * parameters.limits.reach_side
        within = replace(parameters.limits, combined=combined, reach_side=side, **speed)
        trial.parameters = replace(parameters, limits=within)
        walks = list(_random_walks(trial, speed, scale))
        falls = sum(walk.falls for walk in walks)
        limiting = walks[-1].limit(robot.model)
        envelope = f"{_text(speed)}, combined {combined:g}, reach {reach:g}"
        because = f": {limiting}" if falls else ""
        report(f"random commands in {envelope}: {falls} falls in {len(walks)} walks{because}")
        if not falls:
            limited = replace(robot, parameters=trial.parameters)
            failed = [result for result in check_robot(limited)[0] if result.reason()]
            report(f"check in {envelope}: {failed[0].reason() if failed else 'passed'}")
            if not failed:
                break
            limiting = failed[0].limit
        if combined > 1.0:  # each axis alone is walked well
            combined = 1.0
            continue
        reach = NARROW if reach == 1.0 else 1.0
        if reach == NARROW:
            continue
        speed = {axis: _digits(SHRINK * value) for axis, value in speed.items()}
        reasons = dict.fromkeys(AXES, limiting)
    warnings = [
        f"{axis}: {speed[axis] / top:.0%} of the rehearsed {top:.3g}: {reasons[axis]}"
        for axis in AXES
        if speed[axis] < SLOW * (top := float(getattr(parameters.limits, axis)))
    ]
    noise = _odometry_noise(walks)
    sigmas = np.sqrt(np.mean(np.concatenate([w.camera for w in walks]) ** 2, axis=0)).tolist()
    measured = Measured(
        speed={**speed, "combined": combined, "reach": reach},
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


def _require_speed(
    robot: LoadedRobot, speed: Mapping[str, float], reasons: Mapping[str, str]
) -> None:
    """Refuse a robot that is too slow for navigation.

    Raises:
        ModelError: it is; the message names the joint that limits it.
    """
    axis = min(speed, key=lambda axis: speed[axis])
    if speed[axis] < MIN_SPEED:
        raise ModelError(
            f"{robot.name}: {axis}: falls or walks inexactly at higher speeds, got "
            f"{speed[axis]:g}; expected at least {MIN_SPEED:g}: {reasons[axis]}"
        )


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
        speed, reason = SHRINK * speed, walk.limit(trial.robot.model)
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
