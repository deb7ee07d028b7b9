"""What walking asks of the servos."""

import numpy as np
from numpy.typing import NDArray

from walking.value import value

Array = NDArray[np.float64]


@value
class JointTargets:
    """Setpoints of the 26 position servos for one control tick.

    The setpoint sent to the servo is ``position + offset``. The offset makes up for the
    compliance of the servo under the load expected of it (gravity, velocity lag); a body
    without dynamics follows ``position`` alone.

    Attributes:
        position: desired joint angles, order of ``JOINT_NAMES`` (26,) [rad].
        offset: feed-forward offset of the setpoints (26,) [rad].
    """

    position: Array
    offset: Array
