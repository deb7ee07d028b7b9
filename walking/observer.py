"""State estimation and head under a walking controller without a plan: measurements only."""

from typing import Any

import numpy as np

from compilation.record import records
from compilation.value import value
from walking.body.kinematics import inclined
from walking.body.posture import advance_head, head_joints
from walking.body.robot_model import RobotModel
from walking.command import CommandLimits, HeadTarget, VelocityCommand
from walking.constants import joint_records, robot_record
from walking.data import Data, Limbs
from walking.estimate.body import filter_error, pressure
from walking.estimate.odometry import LegOdometry, reckon
from walking.parameters import (
    CONTROL_PERIOD,
    GRAVITY,
    LIGHT_LOAD,
    GaitParameters,
    WalkingParameters,
)
from walking.plan.footsteps import Foothold
from walking.plan.pendulum import dcm
from walking.plan.support import depth, polygon
from walking.plane import Array, PlanePose, Point, from_frame, norm, rotate, rotate_back
from walking.published import CameraRecord, publish_camera
from walking.state import Balance, BodySensors, HeadCameraPose, Phase, WalkingState
from walking.walk import measure_body

CONTACT_LOAD = 2.0 * LIGHT_LOAD  # of the weight; a lifted foot with more of it has landed [1]
VELOCITY_TIME = 0.05  # time constant of the legs in the velocity filter [s]
SLIP = 0.1  # standard deviation of the slip of unknown feet, relative to the distance walked [1]
FULL_LOAD = 0.5  # of the weight on the feet, above which the legs have their full weight [1]


class FootContacts:
    """Contacts of the feet with the floor, by their load with hysteresis.

    A footstep is completed when a foot lands that was lifted for a minimum time. The robot stands
    when both feet have been on the floor for longer than a footstep; it starts standing.

    Args:
        mass: mass of the robot [kg].
        gait: duration of a footstep and minimum time of a foot in the air.

    Attributes:
        on_floor: whether the left and the right foot are on the floor.
        step_count: completed footsteps.
        phase: gait phase; with both feet in the air the last one.
    """

    def __init__(self, mass: float, gait: GaitParameters) -> None:
        weight = mass * GRAVITY
        self._lifted, self._landed = LIGHT_LOAD * weight, CONTACT_LOAD * weight
        self._min_ticks = gait.min_swing_time / CONTROL_PERIOD
        self._step_ticks = gait.footstep_time / CONTROL_PERIOD
        self._in_air = [0, 0]  # ticks since each foot was lifted
        self._both: float = self._step_ticks  # ticks since both are on the floor
        self.on_floor = [True, True]
        self.step_count = 0
        self.phase = Phase.STANDING

    def update(self, left: float, right: float) -> None:
        """Run one tick, given the load of each foot [N]."""
        for side, load in enumerate((left, right)):
            self._in_air[side] = 0 if self.on_floor[side] else self._in_air[side] + 1
            if self.on_floor[side]:
                self.on_floor[side] = load >= self._lifted
            elif load > self._landed:
                self.on_floor[side] = True
                self.step_count += self._in_air[side] >= self._min_ticks
        both = all(self.on_floor)
        self._both = self._both + 1 if both else 0
        if both:
            standing = self._both > self._step_ticks
            self.phase = Phase.STANDING if standing else Phase.DOUBLE_SUPPORT
        elif any(self.on_floor):
            self.phase = Phase.LEFT_SUPPORT if self.on_floor[0] else Phase.RIGHT_SUPPORT


class RollingFeet:
    """Contact points of both feet, and their motion relative to the base.

    The frame of a foot that rolls moves, although the foot does not slide. The point of the sole at
    the centre of pressure does not move.

    Attributes:
        contact: contact point of each foot relative to the base, level axes (2, 3) [m].
        motion: displacement of the points in contact since the last tick, relative to the base;
            axes of the IMU's yaw, z up (2, 3) [m].
        rolled: part of their displacement by rolling, since each foot landed; robot frame
            (2, 2) [m].
    """

    def __init__(self) -> None:
        self.contact = np.zeros((2, 3))
        self.motion = np.zeros((2, 3))
        self.rolled = np.zeros((2, 2))
        self._sum = np.zeros((2, 3))
        self._before: tuple[Array, Array] | None = None

    def update(
        self, position: Array, rotation: Array, pressure: Array, yaw: float, loaded: list[bool]
    ) -> None:
        """Run one tick.

        Args:
            position: position of each foot relative to the base, level axes (2, 3) [m].
            rotation: rotation of each foot, level axes (2, 3, 3).
            pressure: centre of pressure of each foot in its frame, x, y (2, 2) [m].
            yaw: yaw of the IMU [rad].
            loaded: whether the left and the right foot are on the floor.
        """
        c, s = np.cos(yaw), np.sin(yaw)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        arms = np.column_stack([pressure, np.zeros(2)])
        self.contact = position + _rotated(rotation, arms)
        rotated, moved = turn @ rotation, position @ turn.T
        if self._before is not None:
            moved_before, rotation_before = self._before
            rolling = _rotated(rotated - rotation_before, arms)
            self.motion = moved - moved_before + rolling
            self._sum = np.where(np.array(loaded)[:, None], self._sum + rolling, 0.0)
            self.rolled = (self._sum @ turn)[:, :2]
        self._before = moved, rotated


def _rotated(rotations: Array, vectors: Array) -> Array:
    """Return the vectors (n, 3), each multiplied by its matrix (n, 3, 3)."""
    product: Array = np.einsum("kij,kj->ki", rotations, vectors)
    return product


@value
class BodyEstimate:
    """Motion of the trunk, estimated from encoders, IMU and foot sensors.

    Attributes:
        pose: x, y and heading of the robot frame R by leg odometry (3,) [m, m, rad].
        height: height of the base above the floor [m].
        roll, pitch: tilt of the trunk [rad].
        velocity: velocity of the base in its own axes, forward, left and up (3,) [m/s].
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
        parameters: parameters of the estimation.
        odometry: dead reckoning to continue, updated in place.
    """

    def __init__(
        self, robot: RobotModel, parameters: WalkingParameters, odometry: LegOdometry
    ) -> None:
        self._robot, self._odometry = robot, odometry
        self._robots = robot_record(robot, parameters)
        self._walks: Any = np.zeros(1, Data)
        self._body, self._error = self._walks[0].body, self._walks[0].error
        self._contacts = FootContacts(robot.mass, parameters.gait)
        self._full_load = FULL_LOAD * robot.mass * GRAVITY
        self._zmp: Point = (0.0, 0.0)
        self._feet = np.zeros((2, 4))  # in the odometry frame: x, y, height [m], yaw [rad]
        self._rolling = RollingFeet()
        self._step_begin = 0, (0.0, 0.0)  # footsteps and position at the last landing
        self._velocity = np.zeros(3)  # axes of the IMU's yaw, z up [m/s]
        self._sensors: BodySensors | None = None
        self._fallen = False

    @property
    def fallen(self) -> bool:
        """Whether the tilt of the trunk is that of a fallen robot."""
        return self._fallen

    def observe(self, sensors: BodySensors) -> None:
        """Update only the attitude, in a tick in which the robot is off its feet."""
        self._sensors = sensors
        self._fallen = measure_body(self._walks, sensors, self._robot, self._robots)

    def update(self, sensors: BodySensors) -> BodyEstimate:
        """Run one tick; return the estimate."""
        self.observe(sensors)
        body, contacts = self._body, self._contacts
        contacts.update(*body.feet["load"].tolist())
        yaw, tilt = float(body.heading), self._tilt
        measured = body.feet
        feet = np.column_stack([measured[axis] for axis in ("x", "y", "z")])
        self._roll(feet, tilt, yaw)
        left, right = (feet[:, :2] + self._rolling.rolled).tolist()
        reckon(
            self._odometry.records[0],
            yaw,
            ((left[0], left[1]), (right[0], right[1])),
            body.right_load,
            contacts.phase is not Phase.STANDING,
        )
        self._add_slip()
        pose, height = self._pose, self._height
        self._follow_velocity(sensors, tilt, yaw)
        for side, (x, y, z, foot_yaw, *_) in enumerate(measured.tolist()):
            self._feet[side] = *from_frame(pose, x, y), height + z, pose[2] + foot_yaw
        self._follow_com(pose)
        vx, vy, vz = self._velocity.tolist()
        on_left, on_right = contacts.on_floor
        return BodyEstimate(
            pose=np.array(pose),
            height=height,
            roll=float(body.roll),
            pitch=float(body.pitch),
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
        body, error = self._body, self._error
        feet = tuple(
            Foothold(left=side == 0, x=x, y=y, yaw=yaw)
            for side, (x, y, _, yaw) in enumerate(self._feet.tolist())
        )
        support, other = feet if body.right_load < 0.5 else feet[::-1]
        single = self._contacts.phase in (Phase.LEFT_SUPPORT, Phase.RIGHT_SUPPORT)
        corners = polygon(self._robots[0].sole, other, support, single)
        x, y, vx, vy = (float(error[name]) for name in ("x", "y", "vx", "vy"))
        robot = self._robots[0]
        divergent = np.array([dcm(x, vx, robot), dcm(y, vy, robot)])
        return WalkingState(
            phase=self._contacts.phase,
            odometry=self._odometry.pose(),
            camera=self._camera(self._sensors),
            applied_velocity=np.array(command.velocity),
            footsteps=(support, other),
            zmp=np.array(self._zmp),
            dcm=divergent,
            com=np.array(from_frame(self._pose, body.com_x, body.com_y)),
            roll=float(body.roll),
            pitch=float(body.pitch),
            step_count=self._contacts.step_count,
            fallen=self.fallen,
            balance=Balance(
                com=np.array([x, y]),
                dcm=divergent,
                support=corners,
                zmp_depth=depth(corners, *self._zmp),
                feet=self._feet.copy(),
                capture=np.zeros(2),
            ),
            command_limits=CommandLimits(command, command, ()),
        )

    def _camera(self, sensors: BodySensors) -> HeadCameraPose:
        """Return the camera in the robot frame."""
        camera, rates, gyro = np.zeros(1, CameraRecord), sensors.joint_velocity, sensors.gyro
        publish_camera(camera[0], self._body, self._height, rates, gyro, self._robots[0])
        return HeadCameraPose(*camera.item())

    @property
    def _pose(self) -> PlanePose:
        odometry = self._odometry.records[0]
        return float(odometry.x), float(odometry.y), float(odometry.yaw)

    @property
    def _tilt(self) -> Array:
        """Attitude of the trunk R_RB (3, 3)."""
        return np.reshape(inclined(self._body.roll, self._body.pitch), (3, 3))

    @property
    def _height(self) -> float:
        """Height of the base above the contact point of the loaded foot [m]."""
        left, right = self._rolling.contact[:, 2].tolist()
        load = self._body.right_load
        return float(-(1.0 - load) * left - load * right)

    def _roll(self, feet: Array, tilt: Array, yaw: float) -> None:
        """Update the contact points of the feet."""
        rotations = tilt @ self._body.frames[:2, :9].reshape(2, 3, 3)
        centres = self._body.feet
        pressures = np.column_stack([centres["pressure_x"], centres["pressure_y"]])
        self._rolling.update(feet, rotations, pressures, yaw, self._contacts.on_floor)

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
        load = float(self._body.right_load)
        weights = np.array([1.0 - load, load])
        by_legs = -weights @ self._rolling.motion / CONTROL_PERIOD
        left, right = self._body.feet["load"].tolist()
        carried = (left + right) / self._full_load
        gain = min(1.0, carried) * CONTROL_PERIOD / (VELOCITY_TIME + CONTROL_PERIOD)
        self._velocity += gain * (by_legs - self._velocity)

    def _follow_com(self, pose: PlanePose) -> None:
        """Filter the centre of mass as an inverted pendulum over the centre of pressure."""
        body, error = self._body, self._error
        com = from_frame(pose, body.com_x, body.com_y)
        left, right = map(tuple, self._feet[:, [0, 1, 3]].tolist())
        zmp_x, zmp_y, load = pressure(body, left, right)
        if not error.weighted:
            error.x, error.y, error.weighted = *com, True
        self._zmp = (zmp_x, zmp_y) if load > 0.0 else com
        filter_error(error, com, self._zmp, (0.0, 0.0), self._robots[0])


class Head:
    """Head of a robot whose legs something else moves.

    Args:
        robot: model of the robot.
        parameters: parameters of its motion.
    """

    def __init__(self, robot: RobotModel, parameters: WalkingParameters) -> None:
        self._limbs, self._robot = records(Limbs)[0], robot_record(robot, parameters)[0]
        self._joints = joint_records(robot, parameters)
        self._limbs.pan, self._limbs.tilt = robot.neck.angles(robot.ready)

    def advance(self, target: HeadTarget) -> Array:
        """Run one tick; return the setpoints of pan and tilt joint [rad], none if it is fixed."""
        advance_head(self._limbs, (target.pan, target.tilt), self._robot)
        if not self._robot.neck.movable:
            return np.zeros(0)
        pan, tilt = float(self._limbs.pan), float(self._limbs.tilt)
        joints: Array = np.array(head_joints(pan, tilt, self._joints, self._robot))
        return joints
