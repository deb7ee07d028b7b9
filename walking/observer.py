"""State estimation under a walking controller without a plan: measurements only."""

from math import hypot

import numpy as np

from walking import published_state_kernel
from walking.arrays import Array, Point
from walking.body import estimation_kernel
from walking.body.estimation import Estimation
from walking.body.foot_contacts import FootContacts
from walking.body.measurement import BodyMeasurement
from walking.body.odometry import LegOdometry
from walking.body.robot_model import RobotModel
from walking.body.steady_gains import steady_gains
from walking.command import VelocityCommand
from walking.command_limits import CommandLimits
from walking.foothold import Foothold
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.pattern.lipm import Lipm
from walking.pattern.support import SupportPolygon
from walking.phase import Phase
from walking.planar import Frame, from_frame, rotate, rotate_back
from walking.published_state import camera_pose
from walking.sensing import BodySensors
from walking.state import Balance, WalkingState
from walking.value import value

VELOCITY_TIME = 0.02  # time constant of the low-pass filter of the velocity [s]


@value
class BodyEstimate:
    """Motion of the trunk, estimated from encoders, IMU and foot sensors.

    Attributes:
        pose: x, y and heading of the robot frame R by leg odometry (3,) [m, m, rad].
        height: of the base above the floor [m].
        roll, pitch: tilt of the trunk [rad].
        velocity: of the base in its own axes, forward, left and up (3,) [m/s].
        on_floor: whether the left and the right foot are on the floor.
    """

    pose: Array
    height: float
    roll: float
    pitch: float
    velocity: Array
    on_floor: tuple[bool, bool]


class BodyObserver:
    """Estimates attitude, odometry, feet and centre of mass without a plan of the walk.

    Args:
        robot: model of the robot.
        parameters: of the estimation.
        odometry: dead reckoning to continue, updated in place.
    """

    def __init__(
        self, robot: RobotModel, parameters: WalkingParameters, odometry: LegOdometry
    ) -> None:
        self._robot = robot
        self._odometry = odometry
        self._omega = omega = Lipm(parameters.pattern.lipm_height).omega
        self._estimation = Estimation(robot, omega, parameters.estimator, odometry)
        self._contacts = FootContacts(robot.mass, parameters.gait)
        self._fall_tilt = parameters.estimator.fall_tilt
        self._gains = np.array([*steady_gains(omega, parameters.estimator), omega])
        self._com = np.zeros(5)  # state of the filter, see `estimation_kernel.filter_error`
        self._zmp: Point = (0.0, 0.0)
        self._feet = np.zeros((2, 4))  # in the odometry frame: x, y, height [m], yaw [rad]
        self._legs: Array | None = None  # from the base to each foot, odometry axes (2, 3) [m]
        self._velocity = np.zeros(3)
        self._sensors: BodySensors | None = None

    @property
    def fallen(self) -> bool:
        """Whether the tilt of the trunk is that of a fallen robot."""
        tilt = self._estimation.tilt
        return tilt is not None and hypot(*tilt) > self._fall_tilt

    def observe(self, sensors: BodySensors) -> None:
        """Update only the attitude, in a tick in which the robot is off its feet."""
        self._estimation.observe(sensors)
        self._sensors = sensors

    def update(self, sensors: BodySensors) -> BodyEstimate:
        """Run one tick; return the estimate."""
        self.observe(sensors)
        estimation, contacts, body = self._estimation, self._contacts, self._body
        contacts.update(estimation.load(0), estimation.load(1))
        left, right = ((foot.x, foot.y) for foot in body.feet)
        self._odometry.advance(
            float(estimation.measured[2]),
            (left, right),
            body.right_load,
            stepping=contacts.phase is not Phase.STANDING,
        )
        pose = self._pose
        self._follow_velocity(body, pose)
        height = self._height(body)
        for side, foot in enumerate(body.feet):
            x, y = from_frame(pose, foot.x, foot.y)
            self._feet[side] = x, y, height + foot.z, pose[2] + foot.yaw
        self._follow_com(body, pose)
        tilt = np.empty((3, 3))
        published_state_kernel.incline(body.roll, body.pitch, tilt)
        vx, vy, vz = self._velocity.tolist()
        on_left, on_right = contacts.on_floor
        return BodyEstimate(
            pose=np.array(pose),
            height=height,
            roll=body.roll,
            pitch=body.pitch,
            velocity=np.array([*rotate_back(pose[2], vx, vy), vz]) @ tilt,
            on_floor=(on_left, on_right),
        )

    def state(self, command: VelocityCommand) -> WalkingState:
        """Return the state after the last tick under `command`.

        Raises:
            RuntimeError: before the first tick.
        """
        if self._sensors is None:
            raise RuntimeError("the observer has no state before its first tick")
        body, omega = self._body, self._omega
        feet = tuple(
            Foothold(left=side == 0, x=x, y=y, yaw=yaw)
            for side, (x, y, _, yaw) in enumerate(self._feet.tolist())
        )
        support, other = feet if body.right_load < 0.5 else feet[::-1]
        single = self._contacts.phase in (Phase.LEFT_SUPPORT, Phase.RIGHT_SUPPORT)
        polygon = SupportPolygon(self._robot.sole, (support, support if single else other))
        x, y, vx, vy, _ = self._com.tolist()
        dcm = np.array([x + vx / omega, y + vy / omega])
        return WalkingState(
            phase=self._contacts.phase,
            odometry=self._odometry.pose(),
            camera=camera_pose(self._robot, self._sensors, body),
            applied_velocity=np.array(command.velocity),
            footsteps=(support, other),
            zmp=np.array(self._zmp),
            dcm=dcm,
            com=np.array(from_frame(self._pose, body.com[0], body.com[1])),
            roll=body.roll,
            pitch=body.pitch,
            step_count=self._contacts.step_count,
            fallen=self.fallen,
            balance=Balance(
                com=np.array([x, y]),
                dcm=dcm,
                support=polygon.edges()[:, :2].copy(),
                zmp_depth=polygon.depth(*self._zmp),
                feet=self._feet.copy(),
                capture=np.zeros(2),
            ),
            command_limits=CommandLimits(command, command, ()),
        )

    @property
    def _body(self) -> BodyMeasurement:
        body = self._estimation.body
        assert body is not None
        return body

    @property
    def _pose(self) -> Frame:
        x, y, yaw = self._odometry.state[:3].tolist()
        return x, y, yaw

    @staticmethod
    def _height(body: BodyMeasurement) -> float:
        """Return the height of the base above the loaded foot [m]."""
        left, right = body.feet
        return -(1.0 - body.right_load) * left.z - body.right_load * right.z

    def _follow_velocity(self, body: BodyMeasurement, pose: Frame) -> None:
        """Filter the velocity of the base over the loaded feet, which do not move."""
        legs = np.array([(*rotate(pose[2], foot.x, foot.y), foot.z) for foot in body.feet])
        if self._legs is not None:
            left, right = (self._legs - legs) / CONTROL_PERIOD
            measured = (1.0 - body.right_load) * left + body.right_load * right
            gain = CONTROL_PERIOD / (VELOCITY_TIME + CONTROL_PERIOD)
            self._velocity += gain * (measured - self._velocity)
        self._legs = legs

    def _follow_com(self, body: BodyMeasurement, pose: Frame) -> None:
        """Filter the centre of mass as an inverted pendulum over the centre of pressure."""
        com = from_frame(pose, body.com[0], body.com[1])
        frames = np.ascontiguousarray(self._feet[:, [0, 1, 3]])
        zmp_x, zmp_y, load = estimation_kernel.pressure(self._estimation.measured, frames)
        first = self._com[4] == 0.0
        if first:
            self._com[:] = *com, 0.0, 0.0, 1.0
        self._zmp = (zmp_x, zmp_y) if load > 0.0 else com
        estimation_kernel.filter_error(
            self._com, com, self._zmp, (0.0, 0.0), self._gains, CONTROL_PERIOD
        )
