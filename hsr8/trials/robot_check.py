"""Check of a robot: statics, standing and walking in every direction, in full physics."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hsr8.robots.defaults import navigation_speed
from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.model.servos import OWN_SERVOS
from hsr8.robots.walk.rehearsal import command_of
from hsr8.robots.walk.rules import one_leg_load
from hsr8.trials.commands import random_commands, random_head, time_scale
from hsr8.trials.walk import Trial, Walked
from walking.body.robot_model import RobotModel
from walking.command import VelocityCommand

Array = NDArray[np.float64]
Report = Callable[["WalkResult"], None]

WALK_TIME = 9.0  # of each walk, in the time scale of HSR-VIII [s]
FRACTION = 0.5  # of the speed limits at which the robot walks [1]
RANDOM_SEEDS, RANDOM_WALKS = range(4), 3.0  # walks under random commands, and their length [1]
MAX_SATURATED = 0.1  # of the time at maximum torque, of a head joint [1]
MAX_TILT = 8.0  # of the trunk, 99th percentile in a steady walk [deg]
MAX_ERROR = 0.2  # of a velocity that still counts as followed, relative [1]
DIRECTIONS: dict[str, tuple[str, float]] = {  # speed limit, and its sign along the axis
    "stand": ("vx", 0.0),
    "forward": ("vx", 1.0),
    "backward": ("vx_backward", 1.0),
    "left": ("vy", 1.0),
    "right": ("vy", -1.0),
    "turn left": ("wz", 1.0),
    "turn right": ("wz", -1.0),
}


@dataclass(frozen=True, slots=True)
class WalkResult:
    """Result of standing, or of walking in one direction.

    Attributes:
        direction: direction of `DIRECTIONS`.
        speed: commanded [m/s or rad/s].
        fell: whether the robot fell.
        error: maximum velocity error of an axis over the commanded speed [1]; None where the robot
            stands or fell before a stride.
        tilt: 99th percentile of the tilt of the trunk, its maximum under random commands [deg].
        drift: distance from the start while standing [m].
        limit: parts that touch, or the leg joint that was longest at a limit, in words.
    """

    direction: str
    speed: float
    fell: bool
    error: float | None
    tilt: float
    drift: float | None
    limit: str

    def reason(self) -> str | None:
        """Return why the robot failed; None if it did not."""
        if self.fell:
            return f"{self.direction}: fell, {self.limit}"
        if self.tilt > MAX_TILT:
            return f"{self.direction}: tilt {self.tilt:.0f} deg, {self.limit}"
        if self.error is not None and self.error > MAX_ERROR:
            return f"{self.direction}: velocity error {self.error:.0%}, {self.limit}"
        return None


@dataclass(frozen=True, slots=True)
class JointUse:
    """Use of a joint in all walks.

    Attributes:
        joint: name.
        torque: peak over maximum torque [1]; None without a limit.
        speed: peak over maximum speed [1]; None without a limit.
        range: largest distance from the middle of the range over half of it [1]; None without one,
            and of joints that keep their angle.
        saturated: fraction of the time at maximum torque [1].
        stopped: fraction of the time at the end of the range [1].
        one_leg: static torque that carries the robot on one leg, of its maximum [1]; None of other
            joints.
    """

    joint: str
    torque: float | None
    speed: float | None
    range: float | None
    saturated: float
    stopped: float
    one_leg: float | None

    def worst(self) -> float:
        """Return the largest use of a limit [1]."""
        return max(self.torque or 0.0, self.speed or 0.0, self.range or 0.0)


def check_robot(
    robot: LoadedRobot, report: Report = lambda _result: None, duration: float = WALK_TIME
) -> tuple[list[WalkResult], list[JointUse]]:
    """Return the result of each walk, and the use of each joint, the worst first.

    A robot that falls while standing does not walk. One that walks in every direction also walks
    under random commands within the speed limits of navigation, with a moving head; every second
    walk has the maximum speed along all axes at once.

    Args:
        robot: robot to check.
        report: receives each result.
        duration: duration of each walk, in the time scale of HSR-VIII [s].
    """
    trial, results, walks = Trial(robot), [], []
    duration *= time_scale(robot.parameters)
    for direction, (limit, sign) in DIRECTIONS.items():
        speed = FRACTION * getattr(robot.parameters.limits, limit)
        command = command_of(limit, sign * speed)
        walk = trial.walk(command, duration)
        result = _result(direction, command, walk, robot)
        report(result)
        results.append(result)
        walks.append(walk)
        if result.fell and not result.speed:
            break  # a robot that cannot stand cannot walk
    scale = time_scale(robot.parameters)
    for seed in () if any(result.fell for result in results) else RANDOM_SEEDS:
        mixture = {} if seed % 2 else {"stops": 0.0, "corners": 1.0}
        commands = random_commands(navigation_speed(robot), scale, seed, **mixture)
        length = RANDOM_WALKS * duration
        walk = trial.walk(commands, length, seed, head=random_head(robot, seed))
        result = _result(f"random {seed + 1}", None, walk, robot)
        report(result)
        results.append(result)
        walks.append(walk)
    uses = _uses(robot, walks)
    return results, sorted(uses, key=JointUse.worst, reverse=True)


def reasons(
    robot: LoadedRobot, results: Sequence[WalkResult], joints: Sequence[JointUse]
) -> list[str]:
    """Return why a robot failed, and remedies; empty if it stands and walks."""
    weak = [j for j in joints if j.one_leg is not None and j.one_leg > 1.0]
    texts = [
        f"{j.joint}: {j.one_leg:.0%} of its torque to carry the robot on one leg" for j in weak
    ]
    texts += [
        f"{j.joint}: a head joint at its maximum torque for {j.saturated:.0%} of the time: state "
        "a lower head_acceleration"
        for j in joints
        if j.joint in (robot.roles.head or ()) and j.saturated > MAX_SATURATED
    ]
    remedies = []
    failed = [result.direction for result in results if result.fell or result.tilt > MAX_TILT]
    if "stand" in failed and OWN_SERVOS in robot.notes:
        remedies.append('the servos of the model do not hold it: state servo = "rule"')
    elif failed and robot.description.calibration is None:
        remedies.append("`hsr8 robot calibrate` finds speeds at which it does not fall")
    return [reason for result in results if (reason := result.reason())] + texts + remedies


def _result(
    direction: str, command: VelocityCommand | None, walk: Walked, robot: LoadedRobot
) -> WalkResult:
    """Return the result of a walk; of random commands, None, only whether the robot fell."""
    speed = 0.0 if command is None else float(np.abs(command.velocity).max())
    error = drift = None
    if command is None:
        pass
    elif speed:
        difference = np.abs(walk.velocity() - command.velocity).max() / speed
        error = float(difference) if np.isfinite(difference) else None
    else:
        drift = float(np.hypot(*(walk.poses[-1, :2] - walk.poses[0, :2])))
    return WalkResult(
        direction=direction,
        speed=speed,
        fell=bool(walk.falls),
        error=error,
        tilt=float(np.percentile(walk.tilt, 100.0 if command is None else 99.0)),
        drift=drift,
        limit=walk.limit(robot.model),
    )


def _uses(robot: LoadedRobot, walks: Sequence[Walked]) -> Iterator[JointUse]:
    model, ticks = robot.model, sum(len(walk.poses) for walk in walks)
    torque, speed = (
        np.max([getattr(walk.saturation, key) for walk in walks], axis=0)
        for key in ("peak_torque", "peak_speed")
    )
    saturated, stopped = (
        np.sum([getattr(walk.saturation, key) for walk in walks], axis=0) / ticks
        for key in ("torque_ticks", "stop_ticks")
    )
    used = _range_use(model, np.concatenate([walk.angles for walk in walks]))
    loads = one_leg_load(
        model, robot.parameters.gait.half_stance, robot.parameters.pattern.pelvis_height
    )
    roles = robot.roles
    moved = {*roles.legs[0], *roles.legs[1], *(roles.head or ()), *(roles.shoulders or ())}
    for k, name in enumerate(model.names):
        limit = float(model.tree.speed[k])
        yield JointUse(
            joint=name,
            torque=float(torque[k]) if np.isfinite(model.tree.effort[k]) else None,
            speed=float(speed[k]) / limit if np.isfinite(limit) else None,
            range=float(used[k]) if name in moved and np.isfinite(used[k]) else None,
            saturated=float(saturated[k]),
            stopped=float(stopped[k]),
            one_leg=float(loads[k]) if k < len(loads) and loads[k] else None,
        )


def _range_use(model: RobotModel, angles: Array) -> Array:
    """Return the largest distance from the middle of each range over half of it (n,) [1]."""
    middle, half = 0.5 * (model.lower + model.upper), 0.5 * (model.upper - model.lower)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.abs(angles - middle).max(axis=0) / half)
