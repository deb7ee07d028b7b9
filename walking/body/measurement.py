"""One reading of the sensors, put into the level frame of the trunk's heading."""

from walking.value import value

Vector = tuple[float, float, float]


@value
class FootMeasurement:
    """A foot seen from the hips: origin in base_link, z up, x along the heading.

    Attributes:
        x, y, z: position of the foot frame [m].
        yaw: its direction [rad].
        force: load under the sole [N].
    """

    x: float
    y: float
    z: float
    yaw: float
    force: float


@value
class BodyMeasurement:
    """Body as measured, in the level frame at base_link, x along the heading.

    Attributes:
        roll, pitch: filtered tilt of the trunk [rad].
        heading: heading as the IMU reports it [rad].
        gyro: angular velocity of the trunk [rad/s].
        feet: left and right foot.
        com: centre of mass [m].
        right_load: share of the load on the right foot; half in the air [1].
    """

    roll: float
    pitch: float
    heading: float
    gyro: Vector
    feet: tuple[FootMeasurement, FootMeasurement]
    com: Vector
    right_load: float


def body_of(found: list[float]) -> BodyMeasurement:
    """The body of the numbers that `estimation_kernel.observe` finds (24,)."""
    roll, pitch, heading, gx, gy, gz, *feet = found[:16]
    x, y, z, right_load = found[16:20]
    return BodyMeasurement(
        roll,
        pitch,
        heading,
        (gx, gy, gz),
        (FootMeasurement(*feet[:5]), FootMeasurement(*feet[5:])),
        (x, y, z),
        right_load,
    )
