"""Getting up: comes to rest, sees how it lies, turns over if need be, rises, stands still."""

from enum import Enum, auto
from math import atan2, cos

import numpy as np

from walking.body.robot_model import RobotModel
from walking.get_up.get_up_motion import MOTIONS, Motions
from walking.get_up.key_posture import STRAIGHT, KeyPosture
from walking.get_up.lying import Lying, Rest, Vector, lying_on, up_in_trunk
from walking.get_up.posture_track import Array, PostureTrack
from walking.parameters import CONTROL_PERIOD, GetUpParameters
from walking.sensing import BodySensors
from walking.targets import JointTargets

STAND_TIME = 0.8  # from the squat to the ready posture [s]
LONGEST_REST = 3.0  # after so long it sets out though it may still move [s]
LEAN = 0.4  # largest sideways component of the vertical in a posture with a pitch [1]
UPRIGHT = cos(0.2)  # headward component of the vertical from which it stands [1]


class Outcome(Enum):
    """What has become of getting up."""

    UNDER_WAY = auto()
    UP = auto()
    GAVE_UP = auto()


class GetUp:
    """One fall: `step` once per control tick until there is an outcome.

    An attempt ends as soon as a posture has not led to the attitude that it must lead to; the
    robot then lies down straight, and the next attempt starts from how it lies.

    Args:
        robot: limits and ready posture.
        parameters: speed, patience and number of attempts.
        angles: setpoints at the moment of the fall (26,) [rad].
        motions: key postures.

    Attributes:
        outcome: so far.
        attempts: motions begun, turning over and rising each for one.
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
        self._rest = Rest(parameters)
        self._waited = 0
        self.outcome = Outcome.UNDER_WAY
        self.attempts = 0
        self._lie_down()

    @property
    def doing(self) -> str:
        """Name of the posture it moves to."""
        if self._postures:
            return self._postures[0].name
        return "stand" if self._rising else STRAIGHT.name

    def step(self, sensors: BodySensors) -> JointTargets:
        """One control tick.

        Returns:
            setpoints of all joints.
        """
        w, x, y, z = sensors.orientation.tolist()
        gx, gy, gz = sensors.gyro.tolist()
        still = self._rest.update((gx, gy, gz))
        if self.outcome is Outcome.UNDER_WAY:
            self._decide(up_in_trunk((w, x, y, z)), still=still)
        position = self._track.advance()
        return JointTargets(position=position, setpoint=position)

    def _decide(self, up: Vector, *, still: bool) -> None:
        self._waited += 1
        if self._postures:
            self._go_on(up)
        elif self._track.done and (still or self._waited * CONTROL_PERIOD > LONGEST_REST):
            if self._rising and up[2] > UPRIGHT:
                self.outcome = Outcome.UP
            elif self.attempts == self._parameters.max_attempts:
                self.outcome = Outcome.GAVE_UP
            else:
                self._set_out(up)

    def _go_on(self, up: Vector) -> None:
        posture, pitch = self._postures[0], atan2(-up[0], up[2])
        early = posture.until is not None and pitch < posture.until
        if not (early or self._track.done):
            return
        if posture.pitch is not None:
            lowest, highest = posture.pitch
            if not (lowest < pitch < highest and abs(up[1]) < LEAN):
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

    def _set_out(self, up: Vector) -> None:
        """Begin what the side it lies on asks for."""
        self.attempts += 1
        side = lying_on(up)
        self._rising = side is Lying.FRONT
        if self._rising:
            self._postures = list(self._motions.rise)
        else:
            first = 0 if side is Lying.BACK else self._motions.from_side
            # From the back it turns the way it already leans, from a side on to the front.
            over_left = up[1] < 0.0
            self._postures = [p if over_left else p.mirrored() for p in self._motions.roll[first:]]
        self._begin()

    def _begin(self) -> None:
        posture, scale = self._postures[0], self._parameters.time_scale
        self._track.aim(np.array(posture.angles()), posture.time * scale, posture.hold * scale)

    def _lie_down(self) -> None:
        self._postures, self._rising, self._waited = [], False, 0
        self._track.aim(np.array(STRAIGHT.angles()), STRAIGHT.time * self._parameters.time_scale)
