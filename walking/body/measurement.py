"""One reading of the sensors, put into the level frame of the trunk's heading."""

from walking.value import value

Vector = tuple[float, float, float]


@value
class FootMeasurement:
    """A foot seen from the hips: origin in base_link, z up, x along the heading.

    Attributes:
        x, y, z: position of the foot frame [m].
        yaw: its direction [rad].
    """

    x: float
    y: float
    z: float
    yaw: float


@value
class BodyMeasurement:
    """Body as measured, in the level frame at base_link, x along the heading.

    Attributes:
        roll, pitch: filtered tilt of the trunk [rad].
        feet: left and right foot.
        com: centre of mass [m].
        right_load: share of the load on the right foot; half in the air [1].
    """

    roll: float
    pitch: float
    feet: tuple[FootMeasurement, FootMeasurement]
    com: Vector
    right_load: float


def body_of(found: list[float]) -> BodyMeasurement:
    """The body of the numbers that `estimation_kernel.observe` finds (24,)."""
    (x, y, z), right_load = found[16:19], found[19]
    return BodyMeasurement(
        found[0],
        found[1],
        (FootMeasurement(*found[6:10]), FootMeasurement(*found[11:15])),
        (x, y, z),
        right_load,
    )
