"""Check of a robot: statics, standing and walking in every direction, in full physics."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hsr8.robots.loaded import LoadedRobot
from hsr8.trials.walk import Trial, Walked
from walking.body.robot_model import RobotModel
from walking.command import VelocityCommand
from walking.parameters import LimitParameters, WalkingParameters
from walking.rules import one_leg_load

Array = NDArray[np.float64]
Report = Callable[["WalkResult"], None]

WALK_TIME = 9.0  # of each walk, in the time scale of HSR-VIII [s]
FRACTION = 0.5  # of the speed limits at which the robot walks [1]
MAX_ERROR = 0.2  # of a velocity that still counts as followed, relative [1]
DIRECTIONS: dict[str, tuple[str, float]] = {  # speed limit and sign
    "stand": ("vx", 0.0),
    "forward": ("vx", 1.0),
    "backward": ("vx_backward", -1.0),
    "left": ("vy", 1.0),
    "right": ("vy", -1.0),
    "turn left": ("wz", 1.0),
    "turn right": ("wz", -1.0),
}


@dataclass(frozen=True, slots=True)
class WalkResult:
    """Result of standing, or of walking in one direction.

    Attributes:
        direction: of `DIRECTIONS`.
        speed: commanded [m/s or rad/s].
        fell: whether the robot fell.
        error: maximum velocity error of an axis over the commanded speed [1]; None where the robot
            stands or fell before a stride.
        tilt: 99th percentile of the tilt of the trunk [deg].
        drift: distance from the start while standing [m].
    """

    direction: str
    speed: float
    fell: bool
    error: float | None
    tilt: float
    drift: float | None

    def reason(self) -> str | None:
        """Return why the robot failed; None if it did not."""
        if self.fell:
            return f"{self.direction}: fell"
        if self.error is not None and self.error > MAX_ERROR:
            return f"{self.direction}: velocity error {self.error:.0%}"
        return None


@dataclass(frozen=True, slots=True)
class JointUse:
    """Use of a joint in all walks.

    Attributes:
        joint: name.
        torque: peak over maximum torque [1].
        speed: peak over maximum speed [1]; None without a limit.
        range: largest distance from the middle of the range over half of it [1]; None without one,
            and of joints that keep their angle.
        saturated: fraction of the time at maximum torque [1].
        stopped: fraction of the time at the end of the range [1].
        one_leg: static torque that carries the robot on one leg, of its maximum [1]; None of other
            joints.
    """

    joint: str
    torque: float
    speed: float | None
    range: float | None
    saturated: float
    stopped: float
    one_leg: float | None

    def worst(self) -> float:
        """Return the largest use of a limit [1]."""
        return max(self.torque, self.speed or 0.0, self.range or 0.0)


def check_robot(
    robot: LoadedRobot, report: Report = lambda _result: None, duration: float = WALK_TIME
) -> tuple[list[WalkResult], list[JointUse]]:
    """Return the result of each walk, and the use of each joint, the worst first.

    A robot that falls while standing does not walk.

    Args:
        robot: to check.
        report: receives each result.
        duration: of each walk, in the time scale of HSR-VIII [s].
    """
    trial, results, walks = Trial(robot), [], []
    step = robot.parameters.gait.footstep_time
    duration *= step / WalkingParameters().gait.footstep_time
    for direction, (limit, sign) in DIRECTIONS.items():
        command = _command(robot.parameters.limits, limit, sign)
        walk = trial.walk(command, duration)
        result = _result(direction, command, walk)
        report(result)
        results.append(result)
        walks.append(walk)
        if result.fell and not result.speed:
            break  # a robot that cannot stand cannot walk
    uses = _uses(robot, walks)
    return results, sorted(uses, key=JointUse.worst, reverse=True)


def reasons(results: Sequence[WalkResult], joints: Sequence[JointUse]) -> list[str]:
    """Return why a robot failed; empty if it stands and walks."""
    weak = [j for j in joints if j.one_leg is not None and j.one_leg > 1.0]
    texts = [
        f"{j.joint}: {j.one_leg:.0%} of its torque to carry the robot on one leg" for j in weak
    ]
    return [reason for result in results if (reason := result.reason())] + texts


def _command(limits: LimitParameters, limit: str, sign: float) -> VelocityCommand:
    speed = sign * FRACTION * getattr(limits, limit)
    return VelocityCommand(**{limit.removesuffix("_backward"): speed})


def _result(direction: str, command: VelocityCommand, walk: Walked) -> WalkResult:
    speed = float(np.abs(command.velocity).max())
    error = None
    if speed:
        difference = np.abs(walk.velocity() - command.velocity).max() / speed
        error = float(difference) if np.isfinite(difference) else None
    drift = None if speed else float(np.hypot(*(walk.poses[-1, :2] - walk.poses[0, :2])))
    tilt = float(np.percentile(walk.tilt, 99.0))
    return WalkResult(direction, speed, bool(walk.falls), error, tilt, drift)


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
            torque=float(torque[k]),
            speed=float(speed[k]) / limit if np.isfinite(limit) else None,
            range=float(used[k]) if name in moved and np.isfinite(used[k]) else None,
            saturated=float(saturated[k]),
            stopped=float(stopped[k]),
            one_leg=float(loads[k]) if k < len(loads) else None,
        )


def _range_use(model: RobotModel, angles: Array) -> Array:
    """Return the largest distance from the middle of each range over half of it (n,) [1]."""
    middle, half = 0.5 * (model.lower + model.upper), 0.5 * (model.upper - model.lower)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.abs(angles - middle).max(axis=0) / half)
