"""State estimation under a walking controller without a plan: measurements only."""

from math import asin, atan2

import numpy as np

from walking import published_state_kernel
from walking.arrays import Array, Point
from walking.body import estimation_kernel
from walking.body.estimation import Estimation
from walking.body.foot_contacts import FootContacts
from walking.body.measurement import BodyMeasurement
from walking.body.odometry import LegOdometry
from walking.body.robot_model import RobotModel
from walking.body.rolling_feet import RollingFeet
from walking.body.steady_gains import steady_gains
from walking.command import VelocityCommand
from walking.command_limits import CommandLimits
from walking.foothold import Foothold
from walking.parameters import CONTROL_PERIOD, GRAVITY, WalkingParameters
from walking.pattern.lipm import Lipm
from walking.pattern.support import SupportPolygon
from walking.phase import Phase
from walking.planar import Frame, from_frame, norm, rotate, rotate_back
from walking.sensing import BodySensors
from walking.state import Balance, HeadCameraPose, WalkingState
from walking.value import value

VELOCITY_TIME = 0.05  # time constant of the legs in the velocity filter [s]
PRESSURE = 20  # index of the centres of pressure in the measurements
SLIP = 0.1  # standard deviation of the slip of unknown feet, relative to the distance walked [1]
FULL_LOAD = 0.5  # of the weight on the feet, above which the legs have their full weight [1]


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
        self._robot = robot = robot.with_own_buffers()
        self._odometry = odometry
        self._omega = omega = Lipm(parameters.pattern.lipm_height).omega
        self._estimation = Estimation(robot, omega, parameters.estimator, odometry)
        self._contacts = FootContacts(robot.mass, parameters.gait)
        self._full_load = FULL_LOAD * robot.mass * GRAVITY
        self._fall_tilt = parameters.estimator.fall_tilt
        self._gains = np.array([*steady_gains(omega, parameters.estimator), omega])
        self._com = np.zeros(5)  # state of the filter, see `estimation_kernel.filter_error`
        self._zmp: Point = (0.0, 0.0)
        self._feet = np.zeros((2, 4))  # in the odometry frame: x, y, height [m], yaw [rad]
        self._rolling = RollingFeet()
        self._step_begin = 0, (0.0, 0.0)  # footsteps and position at the last landing
        self._velocity = np.zeros(3)  # axes of the IMU's yaw, z up [m/s]
        self._sensors: BodySensors | None = None

    @property
    def fallen(self) -> bool:
        """Whether the tilt of the trunk is that of a fallen robot."""
        tilt = self._estimation.tilt
        return tilt is not None and norm(*tilt) > self._fall_tilt

    def observe(self, sensors: BodySensors) -> None:
        """Update only the attitude, in a tick in which the robot is off its feet."""
        self._estimation.observe(sensors)
        self._sensors = sensors

    def update(self, sensors: BodySensors) -> BodyEstimate:
        """Run one tick; return the estimate."""
        self.observe(sensors)
        estimation, contacts = self._estimation, self._contacts
        contacts.update(estimation.load(0), estimation.load(1))
        yaw, body, tilt = float(estimation.measured[2]), self._body, np.empty((3, 3))
        published_state_kernel.incline(body.roll, body.pitch, tilt)
        feet = np.array([(foot.x, foot.y, foot.z) for foot in body.feet])
        self._roll(sensors, feet, tilt, yaw)
        left, right = (feet[:, :2] + self._rolling.rolled).tolist()
        self._odometry.advance(
            yaw,
            ((left[0], left[1]), (right[0], right[1])),
            body.right_load,
            stepping=contacts.phase is not Phase.STANDING,
        )
        self._add_slip()
        pose, height = self._pose, self._height
        self._follow_velocity(sensors, tilt, yaw)
        for side, foot in enumerate(body.feet):
            x, y = from_frame(pose, foot.x, foot.y)
            self._feet[side] = x, y, height + foot.z, pose[2] + foot.yaw
        self._follow_com(body, pose)
        vx, vy, vz = self._velocity.tolist()
        on_left, on_right = contacts.on_floor
        return BodyEstimate(
            pose=np.array(pose),
            height=height,
            roll=body.roll,
            pitch=body.pitch,
            velocity=np.array([*rotate_back(yaw, vx, vy), vz]) @ tilt,
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
            camera=self._camera(self._sensors, body),
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

    def _camera(self, sensors: BodySensors, body: BodyMeasurement) -> HeadCameraPose:
        """Return the camera in the robot frame; every joint that carries it may move."""
        rotation, position = self._robot.frame_pose(self._robot.tree.camera, sensors.joint_position)
        tilt = np.empty((3, 3))
        published_state_kernel.incline(body.roll, body.pitch, tilt)
        ahead, left, up = rotation[:, 2].tolist()
        pan_rate, tilt_rate = self._robot.neck.rates(sensors.joint_velocity)
        return HeadCameraPose(
            rotation=tilt @ rotation,
            position=tilt @ position + (0.0, 0.0, self._height),
            pan=atan2(left, ahead),
            tilt=asin(min(1.0, max(-1.0, up))),
            pan_rate=pan_rate,
            tilt_rate=tilt_rate,
            yaw_rate=float(tilt[2] @ sensors.gyro),
        )

    @property
    def _pose(self) -> Frame:
        x, y, yaw = self._odometry.state[:3].tolist()
        return x, y, yaw

    @property
    def _height(self) -> float:
        """Height of the base above the contact point of the loaded foot [m]."""
        left, right = self._rolling.contact[:, 2].tolist()
        load = self._body.right_load
        return float(-(1.0 - load) * left - load * right)

    def _roll(self, sensors: BodySensors, feet: Array, tilt: Array, yaw: float) -> None:
        """Update the contact points of the feet."""
        joints = sensors.joint_position
        feet_frames = self._robot.tree.feet
        rotations = [tilt @ self._robot.frame_pose(frame, joints)[0] for frame in feet_frames]
        pressure = self._estimation.measured[PRESSURE:].reshape(2, 2)
        self._rolling.update(feet, np.array(rotations), pressure, yaw, self._contacts.on_floor)

    def _add_slip(self) -> None:
        """Add the unmeasured slip of every footstep to the covariance of the odometry."""
        steps, (x, y) = self._step_begin
        if self._contacts.step_count != steps:
            here, there, _ = self._pose
            self._odometry.slip(SLIP * norm(here - x, there - y))
            self._step_begin = self._contacts.step_count, (here, there)

    def _follow_velocity(self, sensors: BodySensors, tilt: Array, yaw: float) -> None:
        """Integrate the accelerometer, corrected by the legs over the points of contact."""
        ax, ay, az = (tilt @ sensors.accelerometer).tolist()
        self._velocity += CONTROL_PERIOD * np.array([*rotate(yaw, ax, ay), az - GRAVITY])
        load = self._body.right_load
        weights = np.array([1.0 - load, load])
        by_legs = -weights @ self._rolling.motion / CONTROL_PERIOD
        carried = (self._estimation.load(0) + self._estimation.load(1)) / self._full_load
        gain = min(1.0, carried) * CONTROL_PERIOD / (VELOCITY_TIME + CONTROL_PERIOD)
        self._velocity += gain * (by_legs - self._velocity)

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
