"""The walking engine: one control tick from sensors and commands to joint targets."""

from math import cos, hypot, sin

import numpy as np

from walking.admission import AdmissionReport, Limit
from walking.catching import CatchingPendulum
from walking.caution import Caution
from walking.com_error import ComError
from walking.command import Command, CommandState, HeadTarget
from walking.estimator import TiltFilter, TouchDown
from walking.feedforward import FeedForward
from walking.footsteps import FootstepPlanner
from walking.gait import Gait
from walking.generator import make_generator
from walking.head import Head
from walking.heading_hold import HeadingHold
from walking.joints import HEAD
from walking.lipm import Lipm
from walking.measurement import BodyMeasurement, measure
from walking.odometry import LegOdometry
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.pattern import PendulumState, ZmpRamp, dcm_reference
from walking.posture import Posture, ready_stance
from walking.robot_model import RobotModel
from walking.rotation import roll_pitch_yaw
from walking.sensing import BodySensors
from walking.snapshot import PlanToOdometry, balance, camera_pose
from walking.stabilizer import Capture, Stabilizer
from walking.state import Footstep, WalkingState
from walking.steering import Steering
from walking.stride import Strides
from walking.support import Footing, SupportRegion, depth, support_region
from walking.swing_reaction import SwingCompensation, leg_reaction
from walking.targets import JointTargets
from walking.transition import Transition


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
        self._lipm = Lipm(pattern.lipm_height)
        self._generator = make_generator(self._lipm, pattern, robot.sole)
        self._planner = FootstepPlanner(parameters.gait, parameters.limits, robot.sole)
        stance = ready_stance(robot)
        self._gait = Gait(parameters, self._planner, stance)
        zmp = self._gait.plan(stance[1], self._planner.still, moving=False)[-1]
        self._pendulum = PendulumState(zmp.bx, zmp.by, zmp_x=zmp.bx, zmp_y=zmp.by)
        self._steering = Steering(self._planner, parameters.limits)
        self._catching = CatchingPendulum(
            self._lipm, self._generator, self._gait, pattern.dcm_gain, self._pendulum
        )
        self._transition = Transition(self._gait, self._generator)
        self._binding: list[Limit] = []
        self._given = self._steering.velocity
        self._tilt = TiltFilter(parameters.estimator)
        self._error = ComError(self._lipm.omega, parameters.estimator)
        self._touch = TouchDown(parameters.estimator)
        self._caution = Caution(parameters.stabilizer)
        self._stabilizer = Stabilizer(robot, parameters.stabilizer, self._lipm.omega)
        self._posture = Posture(robot, parameters)
        base = pattern.pelvis_height - robot.legs[0].hip_z
        self._feedforward = FeedForward(robot, parameters.stabilizer, base)
        reaction = leg_reaction(robot, base, parameters.gait.lift)
        self._compensation = SwingCompensation(self._lipm, reaction)
        self._odometry = odometry or LegOdometry(parameters.odometry)
        ready = robot.ready[HEAD].tolist()
        self._head = Head(ready[0], ready[1], robot.head_limits(), parameters.head)
        self._pelvis = self._posture.pelvis(self._gait, (self._pendulum.x, self._pendulum.y))
        self._planned_com = robot.com(robot.ready)
        self._turn_rate = 0.0
        self._zmp_shift = (0.0, 0.0)
        self._heading = HeadingHold(parameters.stabilizer)
        self._last_opening_left = False
        self._footing = Footing(robot.sole, self._gait.support_feet)
        self._capture = (0.0, 0.0)
        self._ticks = 0
        self._sensors: BodySensors | None = None
        self._body: BodyMeasurement | None = None

    @property
    def parameters(self) -> WalkingParameters:
        """Parameters of the engine, its speed limits among them."""
        return self._parameters

    @property
    def admission(self) -> AdmissionReport:
        """What became of the last tick's command."""
        strides = self._transition.strides if self._transition.share < 1.0 else None
        return self._steering.report(self._binding, self._given, strides, self._gait.timing)

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Constraints that altered the last tick's command, none if it is obeyed."""
        return (*self._steering.bound, *self._binding)

    @property
    def zmp_depth(self) -> float:
        """How far the last tick's planned ZMP lay inside the soles that carry it [m]."""
        return depth(self._footing.polygon(), self._pendulum.zmp_x, self._pendulum.zmp_y)

    def step(self, sensors: BodySensors, command: Command, head: HeadTarget) -> JointTargets:
        """One control tick.

        Args:
            sensors: read at the start of the tick.
            command: velocity or footsteps wanted, new in any tick; limited to what the legs
                can do, see `admission`.
            head: direction to look; limited to what the neck can do.

        Returns:
            set-points of all joints.
        """
        body = self._sense(sensors)
        left, right = body.feet
        self._odometry.update(
            body.heading,
            ((left.x, left.y), (right.x, right.y)),
            body.right_load,
            stepping=self._gait.stepping,
        )
        error = self._estimate(body)
        self._transition.remember()
        self._command(command, error)
        wish = self._wish()
        moving = self._steering.moving
        gait = self._gait
        if not gait.stepping:
            self._maybe_start(error, moving=moving)
        region = self._region(self._parameters.pattern.sole_margin)
        ramps = self._plan(body, wish, error, region)
        if self._selects:
            moving = self._transition.moving
        self._catching.advance(ramps, self._transition.landing, region)
        pendulum = self._pendulum
        zmp = (pendulum.zmp_x, pendulum.zmp_y)
        load = self._right_load(region, zmp)
        reachable = self._region(self._parameters.stabilizer.sole_margin)
        self._zmp_shift = self._stabilizer.zmp_shift(zmp, error, reachable)
        self._footing.feet = gait.support_feet
        gait.advance(moving=moving)
        self._catching.touch_down()
        return self._realize(body, zmp, load, self._head.advance(head))

    def observe(self, sensors: BodySensors) -> None:
        """A tick in which something else moves the joints: only the attitude is followed."""
        self._sense(sensors)

    def state(self) -> WalkingState:
        """Snapshot after the last tick; it changes nothing.

        Raises:
            RuntimeError: no tick has been made yet.
        """
        if self._sensors is None or self._body is None:
            raise RuntimeError("the walking engine has no state before its first tick")
        body, gait, pendulum = self._body, self._gait, self._pendulum
        odometry = self._odometry.pose()
        plan = PlanToOdometry(gait.footholds[gait.support], body, gait.support, odometry)
        w = self._lipm.omega
        c, s = cos(odometry.yaw), sin(odometry.yaw)
        x, y, _ = body.com
        return WalkingState(
            phase=gait.phase,
            odometry=odometry,
            camera=camera_pose(self._robot, self._sensors, body),
            given=np.array(self._given),
            footsteps=tuple(plan.footstep(step) for step in gait.footsteps()),
            zmp=plan.point(pendulum.zmp_x, pendulum.zmp_y),
            dcm=plan.point(pendulum.x + pendulum.vx / w, pendulum.y + pendulum.vy / w),
            com=np.array([odometry.x + c * x - s * y, odometry.y + s * x + c * y]),
            roll=body.roll,
            pitch=body.pitch,
            step_count=gait.completed,
            fallen=self.fallen,
            balance=balance(
                plan,
                gait,
                pendulum,
                error=self._error.filter,
                omega=w,
                footing=self._footing,
                capture=self._capture,
            ),
            admission=self.admission,
        )

    @property
    def fallen(self) -> bool:
        """Whether the trunk is tilted so far that the robot must have fallen."""
        limit = self._parameters.estimator.fall_tilt
        return hypot(self._tilt.roll, self._tilt.pitch) > limit

    def _sense(self, sensors: BodySensors) -> BodyMeasurement:
        w, x, y, z = sensors.orientation.tolist()
        roll, pitch, heading = roll_pitch_yaw((w, x, y, z))
        self._tilt.update(roll, pitch, sensors.gyro.tolist())
        body = measure(self._robot, sensors, self._tilt.roll, self._tilt.pitch, heading)
        self._sensors, self._body = sensors, body
        self._ticks += 1
        return body

    def _estimate(self, body: BodyMeasurement) -> tuple[float, float]:
        """DCM error of the body against the pendulum, in the plan frame [m]."""
        pelvis = self._pelvis
        c, s = cos(pelvis.yaw), sin(pelvis.yaw)
        px, py, _ = self._planned_com
        planned = (pelvis.x + c * px - s * py, pelvis.y + s * px + c * py)
        slip = body.gyro[2] - self._turn_rate
        return self._error.update(body, self._gait, planned, slip, self._zmp_shift)

    def _command(self, command: Command, error: tuple[float, float]) -> None:
        settled = self._ticks * CONTROL_PERIOD > self._parameters.gait.settle_time
        off = hypot(*error)
        balanced = off < self._parameters.stabilizer.slew_error
        share = self._caution.update(off)
        self._steering.follow(command, share, settled=settled, balanced=balanced)
        retimed = self._gait.retime(self._steering.timing)
        late = isinstance(command, CommandState) and not retimed
        self._binding = [Limit.TIMING] if late else []

    def _wish(self) -> Strides:
        """What the footsteps obey, with the heading hold."""
        ahead = self._pelvis.yaw - self._odometry.yaw
        if not self._gait.stepping:
            # Standing, the plan takes the heading as it is.
            self._heading.rest(ahead)
        # The last footsteps only close the stance.
        turning = self._gait.stepping and self._steering.moving
        return self._steering.wish(self._heading.rate(ahead) if turning else 0.0)

    def _maybe_start(self, error: tuple[float, float], *, moving: bool) -> None:
        gait, foot = self._gait, self._gait.footholds[0]
        share = self._parameters.stabilizer.step_error
        pushed = self._stabilizer.exceeds(foot, error, share)
        if self.fallen or not (moving or pushed):
            return
        opening_left = self._planner.opening_left(self._steering.velocity)
        if pushed:
            # The foot on the side of the fall is the one that can catch it.
            opening_left = cos(foot.yaw) * error[1] - sin(foot.yaw) * error[0] > 0.0
        elif opening_left is None:
            opening_left = not self._last_opening_left
        self._last_opening_left = opening_left
        gait.start(1 if opening_left else 0, at_once=pushed)

    def _plan(
        self,
        body: BodyMeasurement,
        wish: Strides,
        error: tuple[float, float],
        region: SupportRegion,
    ) -> list[ZmpRamp]:
        """The ZMP reference; decides on the landing of the swing foot and its time, too."""
        gait = self._gait
        if gait.stepping and not gait.double and not gait.held:
            force = body.feet[gait.swing].force
            if self._touch.update(gait.swing_phase, force) and gait.swing_phase < 1.0:
                gait.touch_down()
        adjustable = gait.adjustable
        ramps, landing = self._reference(wish, region)
        self._capture = (0.0, 0.0)
        if not adjustable:
            if gait.stepping and not self._planner.same(gait.nominal(wish), landing):
                self._binding.append(Limit.LANDING_FROZEN)
            return ramps
        moving, caught = self._steering.moving, landing
        capture = self._catch(landing, ramps, error)
        if capture.ticks < gait.ticks_left and gait.hasten(capture.ticks, capture.landing):
            # The plan was made for other times.
            self._catching.give_up()
            ramps = gait.plan(landing, wish, moving=moving)
            capture = self._catch(landing, ramps, error)
        if not gait.double:
            caught = capture.landing
        self._capture = (caught.x - landing.x, caught.y - landing.y)
        if caught != landing or gait.hurried:
            self._binding.append(Limit.BALANCE)
        gait.aim(caught)
        if gait.landing != landing and not self._selects:
            ramps = gait.plan(gait.landing, wish, moving=moving)
        return ramps

    @property
    def _selects(self) -> bool:
        """Whether the generator has a say in the footsteps; not if they have to be hurried."""
        return self._generator.selective and not self._gait.hurried

    def _catch(
        self, landing: Footstep, ramps: list[ZmpRamp], error: tuple[float, float]
    ) -> Capture:
        """What the footholds of the plan do not catch of the measured DCM."""
        gait, p, w = self._gait, self._pendulum, self._lipm.omega
        support = gait.footholds[gait.support]
        if gait.hurried:
            x, y = dcm_reference(self._lipm, ramps)
        else:
            x, y = self._generator.planned_dcm(self._catching.planned, ramps)
        off = (p.x + p.vx / w + error[0] - x, p.y + p.vy / w + error[1] - y)
        ahead = (x - ramps[0].bx, y - ramps[0].by)
        return self._stabilizer.capture(
            self._planner, support, landing, off, ahead, ticks_left=gait.ticks_left
        )

    def _reference(self, wish: Strides, region: SupportRegion) -> tuple[list[ZmpRamp], Footstep]:
        """Reference of the plan that the generator admits, and the landing in it."""
        gait, transition, moving = self._gait, self._transition, self._steering.moving
        wanted = self._steering.velocity
        if not self._selects:
            self._given = wanted
            transition.skip(wish, moving=moving)
            landing = gait.nominal(wish) if gait.adjustable else gait.landing
            return gait.plan(landing, wish, moving=moving), landing
        ramps = transition.admit(
            self._catching.planned,
            region,
            wish,
            moving=moving,
            caught=self._catching.caught,
        )
        share = transition.share
        if share < 1.0:
            self._binding.append(Limit.ZMP_REGION)
            a, b, c = (g + share * (w - g) for g, w in zip(self._given, wanted, strict=True))
            self._given = (a, b, c)
        else:
            self._given = wanted
        return ramps, transition.landing

    def _region(self, margin: float) -> SupportRegion:
        first, second = self._gait.support_feet
        return support_region(self._robot.sole, first, second, margin)

    def _right_load(self, region: SupportRegion, zmp: tuple[float, float]) -> float:
        """Planned share of the weight on the right foot."""
        gait = self._gait
        loading = region.share(*zmp) if gait.double else 1.0
        return loading if gait.support == 1 else 1.0 - loading

    def _realize(
        self,
        body: BodyMeasurement,
        zmp: tuple[float, float],
        right_load: float,
        head: tuple[float, float],
    ) -> JointTargets:
        gait, pendulum = self._gait, self._pendulum
        before = self._pelvis.yaw
        compensation = self._compensation
        compensation.advance(gait.swings())
        (ox, oy), (ex, ey) = compensation.offset, compensation.acceleration
        pelvis = self._posture.pelvis(gait, (pendulum.x + ox, pendulum.y + oy))
        self._turn_rate = (pelvis.yaw - before) / CONTROL_PERIOD
        self._pelvis = pelvis
        angles, legs = self._posture.joints(gait, pelvis, (body.roll, body.pitch), head)
        position = np.array(angles)
        self._planned_com = self._robot.com(position)
        c, s = cos(pelvis.yaw), sin(pelvis.yaw)
        soles = []
        for foot in gait.footholds:
            x, y = gait.zmp_point(foot)
            dx, dy = x - pelvis.x, y - pelvis.y
            soles.append((c * dx + s * dy, c * dy - s * dx))
        w2 = self._lipm.omega**2
        ax, ay = w2 * (pendulum.x - zmp[0]) + ex, w2 * (pendulum.y - zmp[1]) + ey
        offset = self._feedforward.offsets(
            position, legs, (soles[0], soles[1]), right_load, (c * ax + s * ay, c * ay - s * ax)
        )
        for index, load in ((0, 1.0 - right_load), (1, right_load)):
            ankle = self._stabilizer.ankles(gait.footholds[index], load, self._zmp_shift, body.gyro)
            offset[6 * index + 4] += ankle.pitch
            offset[6 * index + 5] += ankle.roll
        return JointTargets(position=position, offset=offset)
