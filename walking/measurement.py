"""One reading of the sensors, put into the level frame of the trunk's heading."""

from math import cos, sin

from walking.joints import LEFT_LEG, RIGHT_LEG
from walking.leg_kinematics import Vector, foot_pose
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
    cr, sr, cp, sp = cos(roll), sin(roll), cos(pitch), sin(pitch)

    def level(x: float, y: float, z: float) -> Vector:
        depth = sr * y + cr * z
        return cp * x + sp * depth, cr * y - sr * z, cp * depth - sp * x

    feet = []
    for leg, part, pads in zip(
        robot.legs, (LEFT_LEG, RIGHT_LEG), sensors.foot_force.tolist(), strict=True
    ):
        a, b, c, d, e, f = sensors.joint_position[part].tolist()
        foot = foot_pose(leg, (a, b, c, d, e, f))
        x, y, z = level(foot.x, foot.y, foot.z)
        front_left, front_right, back_left, back_right = pads
        force = sum(pads)
        pressure = robot.sole.centre, 0.0
        if force > 0.0:
            # The floor pushes at the soles' corners.
            length, width = robot.sole.half_length / force, robot.sole.half_width / force
            pressure = (
                robot.sole.centre + length * (front_left + front_right - back_left - back_right),
                width * (front_left + back_left - front_right - back_right),
            )
        feet.append(FootMeasurement(x, y, z, foot.yaw, force, pressure))
    light = LIGHT_LOAD * robot.mass * GRAVITY
    on_left, on_right = (max(0.0, foot.force - light) for foot in feet)
    both = on_left + on_right
    return BodyMeasurement(
        roll=roll,
        pitch=pitch,
        heading=heading,
        gyro=sensors.gyro.tolist(),
        feet=(feet[0], feet[1]),
        com=level(*robot.com(sensors.joint_position)),
        right_load=on_right / both if both > 0.0 else 0.5,
    )
