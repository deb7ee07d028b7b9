"""Walking engine: sensors and commands to joint targets, once per control tick."""

import numpy as np

from walking.arrays import Array, Point
from walking.balance.capture_step import CapturePendulum
from walking.balance.com_offset import ComOffset
from walking.balance.foot_placement import FootPlacement
from walking.balance.stabilizer import Stabilizer
from walking.body.estimation import Estimation
from walking.body.odometry import LegOdometry
from walking.body.robot_model import RobotModel
from walking.command import Command, HeadTarget
from walking.command_limits import CommandLimits, Limit
from walking.footsteps.cycle import GaitCycle
from walking.footsteps.heading_hold import HeadingHold
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.slowdown import Slowdown
from walking.footsteps.speed_hold import SpeedHold
from walking.footsteps.steering import Steering
from walking.footsteps.stride import STILL, Strides
from walking.gait.gait import Gait
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.pattern.generator import make_generator
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.support import SupportPolygon, SupportRegion
from walking.planar import norm, rotate_back
from walking.published_state import camera_pose, published_plan
from walking.sensing import BodySensors
from walking.servos.head import Head
from walking.servos.posture import ready_stance
from walking.servos.touchdown import TouchdownDetector
from walking.servos.whole_body import WholeBody
from walking.state import WalkingState
from walking.targets import JointTargets

SAME_HEIGHT = 1e-9  # rounding error of swing heights [m]
DIVERGED = 1e6  # distance of the pendulum from the support foot per length of the leg [1]


class PlanDiverged(Exception):
    """The planned motion diverged: the pendulum left the feet, and no walk can follow it."""


class WalkingEngine:
    """Walking engine of a humanoid: call `step` once per control tick of 5 ms.

    The engine starts in the ready posture, stands until a command moves it, and stops with the feet
    side by side.

    Args:
        robot: model of the robot.
        parameters: of the engine.
        odometry: dead reckoning to continue; starts at the origin by default.
    """

    def __init__(
        self, robot: RobotModel, parameters: WalkingParameters, odometry: LegOdometry | None = None
    ) -> None:
        self._robot = robot = robot.with_own_buffers()
        self._parameters = parameters
        pattern = parameters.pattern
        self._lipm = lipm = Lipm(pattern.lipm_height)
        generator = make_generator(lipm, pattern, robot.support)
        self._planner = planner = FootstepPlanner(parameters.gait, parameters.limits, robot.sole)
        stance = ready_stance(robot)
        self._gait = gait = Gait(parameters, planner, stance, robot.support)
        zmp = gait.plan(stance[1], planner.still, moving=False)[-1]
        self._pendulum = PendulumState(zmp.bx, zmp.by, zmp_x=zmp.bx, zmp_y=zmp.by)
        self._steering = Steering(planner, parameters.limits, selective=generator.selective)
        self._stabilizer = Stabilizer(robot, parameters.stabilizer, lipm.omega)
        self._capture = CapturePendulum(lipm, generator, gait, pattern.dcm_gain, self._pendulum)
        self._placement = FootPlacement(
            lipm, generator, planner, gait, stabilizer=self._stabilizer, pendulum=self._capture
        )
        self._whole_body = WholeBody(
            robot, parameters, lipm=lipm, gait=gait, pendulum=self._pendulum
        )
        self._touch = TouchdownDetector(parameters.estimator)
        self._slowdown = Slowdown(parameters.stabilizer)
        self._cycle = GaitCycle()
        self._heading = HeadingHold(parameters.stabilizer)
        self._speed = SpeedHold(parameters.stabilizer)
        self._com_offset = ComOffset(parameters.stabilizer)
        self._odometry = odometry or LegOdometry(parameters.odometry)
        self._estimation = Estimation(robot, lipm.omega, parameters.estimator, self._odometry)
        self._head = Head(robot.neck.angles(robot.ready), robot.neck.range(), parameters.head)
        self._polygon = SupportPolygon(robot.support, gait.support_feet)
        self._fall_tilt = parameters.estimator.fall_tilt
        self._zmp_shift = (0.0, 0.0)
        self._bound: list[Limit] = []
        self._last_opening_left = False
        self._ticks = 0
        self._sensors: BodySensors | None = None

    @property
    def command_limits(self) -> CommandLimits:
        """How the last command was limited."""
        placement = self._placement
        return self._steering.report(
            self._binding, placement.applied, placement.admitted, self._gait.timing
        )

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Constraints that limited the last command."""
        return (*self._steering.bound, *self._binding)

    @property
    def _binding(self) -> list[Limit]:
        """Constraints that limited the strides wanted by the steering."""
        return [*self._bound, *self._placement.bound]

    @property
    def zmp_depth(self) -> float:
        """Distance of the last planned ZMP from the edge of the support polygon [m]."""
        return self._polygon.depth(*self._pendulum.zmp)

    @property
    def heading(self) -> float:
        """Planned heading of the trunk [rad]."""
        return self._whole_body.pelvis[2]

    @property
    def load(self) -> float:
        """Planned load fraction of the right foot [1]."""
        return self._gait.right_weight

    @property
    def leg_angles(self) -> Array:
        """Planned angles of the leg joints, also beyond their limits (12,) [rad]."""
        return self._whole_body.leg_angles

    @property
    def torques(self) -> Array:
        """Planned torques of all joints in the last tick (n,) [N m]."""
        return self._whole_body.torques

    def step(self, sensors: BodySensors, command: Command, head: HeadTarget) -> JointTargets:
        """Run one control tick.

        Args:
            sensors: read at the start of the tick.
            command: velocity or footsteps, new in any tick; limited, see `command_limits`.
            head: gaze direction, limited by rate, acceleration and joint limits.

        Returns:
            setpoints of all joints.

        Raises:
            PlanDiverged: the planned centre of mass is far from the feet, since the sensors
                contradict the plan for long.
        """
        tilt = self._sense(sensors)
        error = self._estimation.dcm_error
        gait, steering, placement = self._gait, self._steering, self._placement
        pendulum, whole_body, polygon = self._pendulum, self._whole_body, self._polygon
        placement.remember()
        self._command(command, error)
        wanted = self._wanted_strides()
        if not gait.stepping and self._settled:
            self._maybe_start(error)
        self._detect_touchdown()
        polygon.update(gait.support_feet)
        region = polygon.region(self._parameters.pattern.sole_margin)
        ramps = placement.decide(wanted, steering.velocity, error, region, moving=steering.moving)
        self._capture.advance(ramps, placement.landing, region)
        self._require_bounded()
        zmp = pendulum.zmp
        load = self._right_load(region, zmp)
        polygon.update(gait.support_feet)
        reachable = polygon.region(self._parameters.stabilizer.sole_margin)
        self._zmp_shift = self._stabilizer.zmp_shift(zmp, error, reachable)
        gait.advance(moving=placement.moving)
        if not gait.double and abs(gait.swing_height - gait.timing.swing_height) > SAME_HEIGHT:
            self._bound.append(Limit.SWING_HEIGHT)
        self._capture.touchdown()
        return whole_body.follow(
            tilt,
            sensors.gyro,
            zmp,
            self._zmp_shift,
            load,
            measured=sensors.joint_position,
            head=self._robot.neck.joints(*self._head.advance(head)),
            offset=self._com_offset.offset,
        )

    def observe(self, sensors: BodySensors) -> None:
        """Update only the attitude in a tick in which something else moves the joints."""
        self._estimation.observe(sensors)
        self._sensors = sensors
        self._ticks += 1

    def state(self) -> WalkingState:
        """Return the state after the last tick.

        Raises:
            RuntimeError: before the first tick.
        """
        body = self._estimation.body
        if self._sensors is None or body is None:
            raise RuntimeError("the walking engine has no state before its first tick")
        gait, pendulum = self._gait, self._pendulum
        odometry = self._odometry.pose()
        plan = published_plan(
            gait,
            pendulum,
            body,
            odometry,
            error=self._estimation.com_error,
            omega=self._lipm.omega,
            polygon=self._polygon,
            capture=self._placement.moved,
        )
        return WalkingState(
            phase=gait.phase,
            odometry=odometry,
            camera=camera_pose(self._robot, self._sensors, body),
            applied_velocity=np.array(self._placement.applied),
            footsteps=plan.footsteps,
            zmp=plan.zmp,
            dcm=plan.dcm,
            com=plan.com,
            roll=body.roll,
            pitch=body.pitch,
            step_count=gait.completed,
            fallen=self.fallen,
            balance=plan.balance,
            command_limits=self.command_limits,
        )

    @property
    def fallen(self) -> bool:
        """Whether the tilt of the trunk is that of a fallen robot."""
        tilt = self._estimation.tilt
        return tilt is not None and norm(*tilt) > self._fall_tilt

    def _sense(self, sensors: BodySensors) -> Point:
        """Update the state estimate; return roll and pitch of the trunk [rad]."""
        gait, whole_body = self._gait, self._whole_body
        zmps = (*self._pendulum.zmp, *self._zmp_shift)
        rest = (whole_body.turn_rate, gait.right_weight)
        plan = (*whole_body.pelvis, *whole_body.com, *zmps, *rest)
        self._sensors = sensors
        self._ticks += 1
        return self._estimation.update(sensors, gait.feet, plan, stepping=gait.stepping)

    @property
    def _settled(self) -> bool:
        """Whether the errors of the start, which the balance step must ignore, have decayed."""
        return self._ticks * CONTROL_PERIOD > self._parameters.gait.settle_time

    def _command(self, command: Command, error: Point) -> None:
        off = norm(*error)
        balanced = off < self._parameters.stabilizer.max_slew_error
        speed_ratio = self._slowdown.update(off)
        self._steering.follow(command, speed_ratio, settled=self._settled, balanced=balanced)
        gait = self._gait
        retimed = gait.retime(self._steering.next_timing(gait.timing, stepping=gait.stepping))
        self._bound = [] if retimed else [Limit.TIMING]

    def _wanted_strides(self) -> Strides:
        """Return the wanted strides, corrected for slip of the feet."""
        estimation, gait, steering = self._estimation, self._gait, self._steering
        ahead = self._whole_body.pelvis[2] - estimation.pose[2]
        if not gait.stepping:
            # While standing the planned heading follows the measured one.
            self._heading.reset(ahead)
            self._cycle.reset()
        if not (gait.stepping and steering.moving):
            # The last footsteps only close the stance.
            self._speed.reset()
            self._com_offset.reset()
            return steering.strides(STILL)
        begins = self._cycle.begins(gait.support)
        moved = norm(*self._placement.moved)
        disturbed = gait.shortened or moved > self._parameters.stabilizer.max_steady_shift
        self._com_offset.update(estimation.pressure_error, begins=begins, disturbed=disturbed)
        vx, vy = self._speed.correction(
            estimation.pose, steering.velocity, begins=begins, disturbed=disturbed
        )
        return steering.strides((vx, vy, self._heading.rate(ahead, renew=begins or disturbed)))

    def _maybe_start(self, error: Point) -> None:
        """Take a first footstep if the command or balance requires it."""
        gait, foot = self._gait, self._gait.footholds[0]
        ratio = self._parameters.stabilizer.step_error_ratio
        pushed = self._stabilizer.exceeds(foot, error, ratio)
        moving = self._steering.moving
        if self.fallen and moving:
            self._bound.append(Limit.FALLEN)
        if self.fallen or not (moving or pushed):
            return
        opening_left = self._planner.opening_left(self._steering.velocity)
        if pushed:
            # Only the foot on the side of the fall can make the capture step.
            if not moving:
                self._bound.append(Limit.BALANCE)
            opening_left = rotate_back(foot.yaw, *error)[1] > 0.0
        elif opening_left is None:
            opening_left = not self._last_opening_left
        self._last_opening_left = opening_left
        gait.start(1 if opening_left else 0, at_once=pushed)
        if not gait.retime(self._steering.timing):
            self._bound.append(Limit.TIMING)

    def _detect_touchdown(self) -> None:
        """Stop the swing foot on early touchdown."""
        gait = self._gait
        if gait.stepping and not gait.double and not gait.landed_early:
            force = self._estimation.load(gait.swing)
            if self._touch.update(gait.swing_phase, force) and gait.swing_phase < 1.0:
                gait.touchdown()

    def _require_bounded(self) -> None:
        pendulum, foot = self._pendulum, self._gait.footholds[self._gait.support]
        distance = max(abs(pendulum.x - foot.x), abs(pendulum.y - foot.y))
        if not distance < DIVERGED * self._robot.legs[0].length:
            raise PlanDiverged(
                f"the planned walk diverged: the centre of mass is {distance:.3g} m from the feet"
            )

    def _right_load(self, region: SupportRegion, zmp: Point) -> float:
        """Return the planned load fraction of the right foot [1]."""
        gait = self._gait
        loading = region.load_fraction(*zmp) if gait.double else 1.0
        return loading if gait.support == 1 else 1.0 - loading
