"""Fall recovery: come to rest, detect the lying side, turn over if needed, rise, stand."""

from enum import Enum, StrEnum, auto
from math import atan2, ceil, cos

import numpy as np

from walking.body.robot_model import RobotModel
from walking.get_up_motions import MOTIONS, STRAIGHT, KeyPosture, Motions
from walking.parameters import CONTROL_PERIOD, GetUpParameters
from walking.plan.swing import PEAK, minimum_jerk
from walking.plane import Array, Vector
from walking.state import BodySensors, JointTargets

STAND_TIME = 0.8  # from the squat to the ready posture [s]
MAX_REST = 3.0  # timeout of waiting for rest [s]
MAX_LEAN = 0.4  # sideways component of the vertical in a posture with a pitch [1]
UPRIGHT = cos(0.2)  # minimum headward component of the vertical when standing [1]


class Lying(StrEnum):
    """Side of the trunk on the floor."""

    FRONT = "front"
    BACK = "back"
    LEFT = "left"
    RIGHT = "right"


def up_in_trunk(quaternion: tuple[float, float, float, float]) -> Vector:
    """Return the vertical in the trunk frame: forward, left and headward component [1].

    Unlike roll and pitch it has no singularity at the pitch of a lying trunk, 90°.

    Args:
        quaternion: attitude of the trunk, w-x-y-z.
    """
    w, x, y, z = quaternion
    return 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)


def lying_on(up: Vector) -> Lying:
    """Return the lying side of a trunk with vertical `up`."""
    forward, left, _ = up
    if abs(forward) >= abs(left):
        return Lying.BACK if forward > 0.0 else Lying.FRONT
    return Lying.RIGHT if left > 0.0 else Lying.LEFT


class RestDetector:
    """Detects that the trunk is at rest.

    Args:
        parameters: maximum rate and its duration.
    """

    def __init__(self, parameters: GetUpParameters) -> None:
        self._rate = parameters.rest_rate
        self._ticks = round(parameters.rest_time / CONTROL_PERIOD)
        self._count = 0

    def update(self, gyro: Vector) -> bool:
        """Whether the trunk is at rest, given this tick's angular velocity [rad/s]."""
        self._count = self._count + 1 if max(map(abs, gyro)) < self._rate else 0
        return self._count >= self._ticks


class PostureTrack:
    """Minimum-jerk motion of all joints within limits of angle and rate.

    Args:
        robot: joint limits.
        speed: maximum joint rate [rad/s].
        angles: initial joint angles (n,) [rad].

    Attributes:
        angles: present setpoints (n,) [rad].
    """

    def __init__(self, robot: RobotModel, speed: float, angles: Array) -> None:
        self._lower, self._upper = robot.lower, robot.upper
        self._speed = speed
        self.angles = self._within(angles)
        self._origin = self._goal = self.angles
        self._ticks, self._tick, self._last = 1, 1, 1

    @property
    def done(self) -> bool:
        """Whether the posture has been reached and held."""
        return self._tick >= self._last

    def aim(self, angles: Array, time: float, hold: float = 0.0) -> None:
        """Start a motion to a posture.

        Args:
            angles: angles of the posture, clipped to the joint limits (n,) [rad].
            time: time of the motion, extended if a joint would be too fast [s].
            hold: time in the posture [s].
        """
        self._origin, self._goal = self.angles, self._within(angles)
        max_change = float(np.abs(self._goal - self._origin).max())
        time = max(time, PEAK * max_change / self._speed, CONTROL_PERIOD)
        self._ticks, self._tick = ceil(time / CONTROL_PERIOD), 0
        self._last = self._ticks + round(hold / CONTROL_PERIOD)

    def advance(self) -> Array:
        """Return the setpoints of the next tick (n,) [rad]."""
        self._tick += 1
        fraction = minimum_jerk(self._tick / self._ticks)
        self.angles = self._origin + fraction * (self._goal - self._origin)
        return self.angles

    def _within(self, angles: Array) -> Array:
        within: Array = np.clip(angles, self._lower, self._upper)
        return within


class Outcome(Enum):
    """Outcome of getting up."""

    UNDER_WAY = auto()
    UP = auto()
    GAVE_UP = auto()


class GetUp:
    """Recovery from one fall: call `step` once per control tick until there is an outcome.

    An attempt fails at a posture that does not reach its required attitude. The robot then lies
    down straight, and the next attempt starts from the side it lies on.

    Args:
        robot: joint limits and ready posture.
        parameters: speeds and number of attempts.
        angles: setpoints at the fall (n,) [rad].
        motions: key postures.

    Attributes:
        outcome: so far.
        attempts: motions started; turning over and rising count as one each.
    """

    def __init__(
        self,
        robot: RobotModel,
        parameters: GetUpParameters,
        angles: Array,
        motions: Motions = MOTIONS,
    ) -> None:
        self._parameters = parameters
        self._motions = motions
        self._ready: Array = robot.ready
        self._track = PostureTrack(robot, parameters.max_joint_speed, angles)
        self._postures: list[KeyPosture] = []
        self._rising = False
        self._rest = RestDetector(parameters)
        self._waited = 0
        self.outcome = Outcome.UNDER_WAY
        self.attempts = 0
        self._lie_down()

    @property
    def doing(self) -> str:
        """Name of the next posture."""
        if self._postures:
            return self._postures[0].name
        return "stand" if self._rising else STRAIGHT.name

    def step(self, sensors: BodySensors) -> JointTargets:
        """Run one control tick and return the setpoints of all joints."""
        w, x, y, z = sensors.orientation.tolist()
        gx, gy, gz = sensors.gyro.tolist()
        at_rest = self._rest.update((gx, gy, gz))
        if self.outcome is Outcome.UNDER_WAY:
            self._decide(up_in_trunk((w, x, y, z)), at_rest=at_rest)
        position = self._track.advance()
        return JointTargets(position=position, setpoint=position)

    def _decide(self, up: Vector, *, at_rest: bool) -> None:
        self._waited += 1
        if self._postures:
            self._next_posture(up)
        elif self._track.done and (at_rest or self._waited * CONTROL_PERIOD > MAX_REST):
            if self._rising and up[2] > UPRIGHT:
                self.outcome = Outcome.UP
            elif self.attempts == self._parameters.max_attempts:
                self.outcome = Outcome.GAVE_UP
            else:
                self._start_attempt(up)

    def _next_posture(self, up: Vector) -> None:
        posture, pitch = self._postures[0], atan2(-up[0], up[2])
        early = posture.until is not None and pitch < posture.until
        if not (early or self._track.done):
            return
        if posture.pitch is not None:
            low, high = posture.pitch
            if not (low < pitch < high and abs(up[1]) < MAX_LEAN):
                self._lie_down()
                return
        del self._postures[0]
        if self._postures:
            self._begin()
        elif self._rising:
            self._track.aim(self._ready, STAND_TIME * self._parameters.time_scale)
            self._waited = 0
        else:
            self._lie_down()

    def _start_attempt(self, up: Vector) -> None:
        """Start the motion for the side it lies on."""
        self.attempts += 1
        side = lying_on(up)
        self._rising = side is Lying.FRONT
        if self._rising:
            self._postures = list(self._motions.rise)
        else:
            first = 0 if side is Lying.BACK else self._motions.from_side
            # From the back it turns to the side it already leans to, from a side to the front.
            over_left = up[1] < 0.0
            self._postures = [p if over_left else p.mirrored() for p in self._motions.roll[first:]]
        self._begin()

    def _begin(self) -> None:
        posture, scale = self._postures[0], self._parameters.time_scale
        self._track.aim(np.array(posture.angles()), posture.time * scale, posture.hold * scale)

    def _lie_down(self) -> None:
        self._postures, self._rising, self._waited = [], False, 0
        self._track.aim(np.array(STRAIGHT.angles()), STRAIGHT.time * self._parameters.time_scale)
