"""The walking engine: one control tick from sensors and commands to joint targets."""

from math import cos, hypot, sin

import numpy as np

from walking.balance.capture_step import CapturePendulum
from walking.balance.com_offset import ComOffset
from walking.balance.foot_placement import FootPlacement
from walking.balance.stabilizer import Stabilizer
from walking.body.estimation import Estimation
from walking.body.joints import HEAD
from walking.body.odometry import LegOdometry
from walking.body.robot_model import RobotModel
from walking.command import Command, HeadTarget
from walking.command_limits import CommandLimits, Limit
from walking.footsteps.cycle import Cycle
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
from walking.pattern.support import Footing, SupportRegion
from walking.published_state import camera_pose, published_plan
from walking.sensing import BodySensors
from walking.servos.head import Head
from walking.servos.posture import ready_stance
from walking.servos.touchdown import TouchdownDetector
from walking.servos.whole_body import WholeBody
from walking.state import WalkingState
from walking.targets import JointTargets

SAME_HEIGHT = 1e-9  # difference of swing heights that is rounding [m]


class WalkingEngine:
    """Walks a humanoid: call `step` once per control tick of 5 ms.

    The engine starts in the ready posture, stands until it is told to move, and stops with
    the feet side by side when it is told to stand.

    Args:
        robot: the robot's numbers.
        parameters: of the engine.
        odometry: dead reckoning to go on with, from the origin if left out.
    """

    def __init__(
        self,
        robot: RobotModel,
        parameters: WalkingParameters,
        odometry: LegOdometry | None = None,
    ) -> None:
        self._robot = robot
        self._parameters = parameters
        pattern = parameters.pattern
        self._lipm = lipm = Lipm(pattern.lipm_height)
        generator = make_generator(lipm, pattern, robot.sole)
        self._planner = planner = FootstepPlanner(parameters.gait, parameters.limits, robot.sole)
        stance = ready_stance(robot)
        self._gait = gait = Gait(parameters, planner, stance)
        zmp = gait.plan(stance[1], planner.still, moving=False)[-1]
        self._pendulum = PendulumState(zmp.bx, zmp.by, zmp_x=zmp.bx, zmp_y=zmp.by)
        self._steering = Steering(planner, parameters.limits, selective=generator.selective)
        self._stabilizer = Stabilizer(robot, parameters.stabilizer, lipm.omega)
        self._capture = CapturePendulum(lipm, generator, gait, pattern.dcm_gain, self._pendulum)
        self._placement = FootPlacement(
            lipm, generator, planner, gait, stabilizer=self._stabilizer, pendulum=self._capture
        )
        self._whole_body = WholeBody(
            robot,
            parameters,
            lipm=lipm,
            gait=gait,
            pendulum=self._pendulum,
        )
        self._touch = TouchdownDetector(parameters.estimator)
        self._caution = Slowdown(parameters.stabilizer)
        self._cycle = Cycle()
        self._heading = HeadingHold(parameters.stabilizer)
        self._speed = SpeedHold(parameters.stabilizer)
        self._pressure = ComOffset(parameters.stabilizer)
        self._odometry = odometry or LegOdometry(parameters.odometry)
        self._estimation = Estimation(robot, lipm.omega, parameters.estimator, self._odometry)
        ready = robot.ready[HEAD].tolist()
        self._head = Head(ready[0], ready[1], robot.head_limits(), parameters.head)
        self._footing = Footing(robot.sole, gait.support_feet)
        self._fall_tilt = parameters.estimator.fall_tilt
        self._zmp_shift = (0.0, 0.0)
        self._bound: list[Limit] = []
        self._last_opening_left = False
        self._ticks = 0
        self._sensors: BodySensors | None = None

    @property
    def parameters(self) -> WalkingParameters:
        """Parameters of the engine, its speed limits among them."""
        return self._parameters

    @property
    def command_limits(self) -> CommandLimits:
        """What became of the last tick's command."""
        placement = self._placement
        return self._steering.report(
            self._binding, placement.applied, placement.admitted, self._gait.timing
        )

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Constraints that altered the last tick's command, none if it is obeyed."""
        return (*self._steering.bound, *self._binding)

    @property
    def _binding(self) -> list[Limit]:
        """Constraints that altered what the steering made of the last tick's command."""
        return [*self._bound, *self._placement.bound]

    @property
    def zmp_depth(self) -> float:
        """How far the last tick's planned ZMP lay inside the soles that carry it [m]."""
        return self._footing.depth(self._pendulum.zmp_x, self._pendulum.zmp_y)

    def step(self, sensors: BodySensors, command: Command, head: HeadTarget) -> JointTargets:
        """One control tick.

        Args:
            sensors: read at the start of the tick.
            command: velocity or footsteps wanted, new in any tick; limited to what the legs
                can do, see `command_limits`.
            head: direction to look; limited to what the neck can do.

        Returns:
            setpoints of all joints.
        """
        tilt = self._sense(sensors)
        error = self._estimation.dcm_error
        gait, steering, placement = self._gait, self._steering, self._placement
        pendulum, whole_body, footing = self._pendulum, self._whole_body, self._footing
        placement.remember()
        self._command(command, error)
        wish = self._wish()
        if not gait.stepping:
            self._maybe_start(error)
        self._feel_floor()
        footing.stand(gait.support_feet)
        region = footing.region(self._parameters.pattern.sole_margin)
        ramps = placement.decide(wish, steering.velocity, error, region, moving=steering.moving)
        self._capture.advance(ramps, placement.landing, region)
        zmp = (pendulum.zmp_x, pendulum.zmp_y)
        load = self._right_load(region, zmp)
        footing.stand(gait.support_feet)
        reachable = footing.region(self._parameters.stabilizer.sole_margin)
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
            head=self._head.advance(head),
            offset=self._pressure.offset,
        )

    def observe(self, sensors: BodySensors) -> None:
        """A tick in which something else moves the joints: only the attitude is followed."""
        self._estimation.observe(sensors)
        self._sensors = sensors
        self._ticks += 1

    def state(self) -> WalkingState:
        """Snapshot after the last tick; it changes nothing.

        Raises:
            RuntimeError: no tick has been made yet.
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
            footing=self._footing,
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
        """Whether the trunk is tilted so far that the robot must have fallen."""
        tilt = self._estimation.tilt
        return tilt is not None and hypot(*tilt) > self._fall_tilt

    def _sense(self, sensors: BodySensors) -> tuple[float, float]:
        """Follow the body; roll and pitch of its trunk [rad]."""
        gait, whole_body, pendulum = self._gait, self._whole_body, self._pendulum
        plan = (
            *whole_body.pelvis,
            *whole_body.com,
            pendulum.zmp_x,
            pendulum.zmp_y,
            *self._zmp_shift,
            whole_body.turn_rate,
            gait.right_weight,
        )
        self._sensors = sensors
        self._ticks += 1
        return self._estimation.update(sensors, gait.feet, plan, stepping=gait.stepping)

    def _command(self, command: Command, error: tuple[float, float]) -> None:
        settled = self._ticks * CONTROL_PERIOD > self._parameters.gait.settle_time
        off = hypot(*error)
        balanced = off < self._parameters.stabilizer.max_slew_error
        share = self._caution.update(off)
        self._steering.follow(command, share, settled=settled, balanced=balanced)
        gait = self._gait
        retimed = gait.retime(self._steering.pace(gait.timing, stepping=gait.stepping))
        self._bound = [] if retimed else [Limit.TIMING]

    def _wish(self) -> Strides:
        """What the footsteps obey, making up for what the feet slip."""
        estimation, gait, steering = self._estimation, self._gait, self._steering
        ahead = self._whole_body.pelvis[2] - estimation.pose[2]
        if not gait.stepping:
            # Standing, the plan takes the heading as it is.
            self._heading.rest(ahead)
            self._cycle.rest()
        if not (gait.stepping and steering.moving):
            # The last footsteps only close the stance.
            self._speed.rest()
            self._pressure.rest()
            return steering.wish(STILL)
        begins = self._cycle.begins(gait.support)
        moved = hypot(*self._placement.moved)
        disturbed = gait.hurried or moved > self._parameters.stabilizer.max_steady_shift
        self._pressure.update(estimation.pressure_error, begins=begins, disturbed=disturbed)
        vx, vy = self._speed.correction(
            estimation.pose,
            steering.velocity,
            begins=begins,
            disturbed=disturbed,
        )
        return steering.wish((vx, vy, self._heading.rate(ahead, renew=begins or disturbed)))

    def _maybe_start(self, error: tuple[float, float]) -> None:
        """Take a first footstep if the command asks for it, or balance."""
        gait, foot = self._gait, self._gait.footholds[0]
        share = self._parameters.stabilizer.step_error_ratio
        pushed = self._stabilizer.exceeds(foot, error, share)
        moving = self._steering.moving
        if self.fallen and moving:
            self._bound.append(Limit.FALLEN)
        if self.fallen or not (moving or pushed):
            return
        opening_left = self._planner.opening_left(self._steering.velocity)
        if pushed:
            # The foot on the side of the fall is the one that can catch it.
            if not moving:
                self._bound.append(Limit.BALANCE)
            opening_left = cos(foot.yaw) * error[1] - sin(foot.yaw) * error[0] > 0.0
        elif opening_left is None:
            opening_left = not self._last_opening_left
        self._last_opening_left = opening_left
        gait.start(1 if opening_left else 0, at_once=pushed)
        if not gait.retime(self._steering.timing):
            self._bound.append(Limit.TIMING)

    def _feel_floor(self) -> None:
        """Leave the swing foot where it has met the floor before its time."""
        gait = self._gait
        if gait.stepping and not gait.double and not gait.held:
            force = self._estimation.load(gait.swing)
            if self._touch.update(gait.swing_phase, force) and gait.swing_phase < 1.0:
                gait.touchdown()

    def _right_load(self, region: SupportRegion, zmp: tuple[float, float]) -> float:
        """Planned share of the weight on the right foot."""
        gait = self._gait
        loading = region.share(*zmp) if gait.double else 1.0
        return loading if gait.support == 1 else 1.0 - loading
