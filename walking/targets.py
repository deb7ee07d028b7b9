"""Joint targets of the position servos."""

from walking.arrays import Array
from walking.value import value


@value
class JointTargets:
    """Setpoints of the position servos for one control tick.

    The setpoint is the desired angle plus a feed-forward offset for the compliance of the servo
    under its expected load (gravity, velocity lag), within the range of the joint. A body without
    dynamics follows `position` alone.

    Attributes:
        position: desired joint angles, order of ``RobotTree`` (n,) [rad].
        setpoint: sent to the servos (n,) [rad].
    """

    position: Array
    setpoint: Array
