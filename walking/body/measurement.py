"""Measured body in the level frame of the trunk's heading."""

from walking.arrays import Vector
from walking.value import value


@value
class FootMeasurement:
    """Measured foot in the level frame.

    Attributes:
        x, y, z: position of the foot frame [m].
        yaw: of the foot frame [rad].
    """

    x: float
    y: float
    z: float
    yaw: float


@value
class BodyMeasurement:
    """Measured body in the level frame: origin in base_link, z up, x along the heading.

    Attributes:
        roll, pitch: filtered tilt of the trunk [rad].
        feet: left and right foot.
        com: centre of mass [m].
        right_load: load fraction of the right foot, 0.5 in the air [1].
    """

    roll: float
    pitch: float
    feet: tuple[FootMeasurement, FootMeasurement]
    com: Vector
    right_load: float


def body_of(measured: list[float]) -> BodyMeasurement:
    """Unpack the measurements of `estimation_kernel.observe` (24,)."""
    (x, y, z), right_load = measured[16:19], measured[19]
    return BodyMeasurement(
        measured[0],
        measured[1],
        (FootMeasurement(*measured[6:10]), FootMeasurement(*measured[11:15])),
        (x, y, z),
        right_load,
    )
