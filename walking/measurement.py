"""One reading of the sensors, put into the level frame of the trunk's heading."""

from math import cos, sin

from walking import leg_kernel
from walking.leg_kernel import Vector
from walking.parameters import GRAVITY
from walking.robot_model import RobotModel
from walking.sensing import BodySensors
from walking.swing import FootReference
from walking.value import value

LIGHT_LOAD = 0.074  # noise of a foot's pads stays below this share of the weight [1]


@value
class FootMeasurement:
    """A foot seen from the hips: origin in base_link, z up, x along the heading.

    Attributes:
        x, y, z: position of the foot frame [m].
        yaw: its direction [rad].
        force: load under the sole [N].
        pressure: centre of that load in the foot frame (2,) [m].
    """

    x: float
    y: float
    z: float
    yaw: float
    force: float
    pressure: tuple[float, float]


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
    gyro: list[float]
    feet: tuple[FootMeasurement, FootMeasurement]
    com: Vector
    right_load: float

    def pressure(self, feet: tuple[FootReference, FootReference]) -> tuple[float, float] | None:
        """Centre of pressure under feet that stand where `feet` are; None in the air (2,) [m]."""
        x = y = load = 0.0
        for measured, foot in zip(self.feet, feet, strict=True):
            (u, v), yaw, force = measured.pressure, foot.yaw.position, measured.force
            c, s = cos(yaw), sin(yaw)
            x += force * (foot.x.position + c * u - s * v)
            y += force * (foot.y.position + s * u + c * v)
            load += force
        return (x / load, y / load) if load > 0.0 else None


def measure(
    robot: RobotModel, sensors: BodySensors, roll: float, pitch: float, heading: float
) -> BodyMeasurement:
    """Kinematics of the measured joints under the given tilt [rad]."""
    sole, joints, tilt = robot.sole, sensors.joint_position, (roll, pitch)
    left, right = leg_kernel.measured_feet(
        joints,
        sensors.foot_force,
        tilt,
        robot.leg_rows,
        (sole.centre, sole.half_length, sole.half_width),
    )
    light = LIGHT_LOAD * robot.mass * GRAVITY
    on_left, on_right = max(0.0, left[4] - light), max(0.0, right[4] - light)
    both = on_left + on_right
    return BodyMeasurement(
        roll=roll,
        pitch=pitch,
        heading=heading,
        gyro=sensors.gyro.tolist(),
        feet=(FootMeasurement(*left[:5], left[5:]), FootMeasurement(*right[:5], right[5:])),
        com=leg_kernel.level(robot.com(joints), tilt),
        right_load=on_right / both if both > 0.0 else 0.5,
    )
