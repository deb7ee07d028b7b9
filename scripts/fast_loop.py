"""Fast study loop: the robot of hsr8 on a planar body, without joints and physics.

Vision, belief, mission, planner, gaze and analytic camera are those of the product; the walking
engine is replaced by a planar body with rate limits and slip. A run takes about a second of
processor time. `scripts/gaze_study.py` compares its results with those of the kinematic body.
"""

from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, inf, sin

from hsr8.decisions import DecisionContext, GazeController, MotionPlanner
from hsr8.loop import Simulation
from hsr8.robot import Robot, SensorFrame
from hsr8.robot_builder import (
    build_decisions,
    build_robot,
    camera_sight,
    field_of_view,
    head_camera,
)
from hsr8.robots.loaded import load_robot
from hsr8.scenario.schema import Scenario
from hsr8.seeds import named_rng
from hsr8.world.camera.analytic import AnalyticCamera
from hsr8.world.camera.faults import CameraFaults
from hsr8.world.field.generator import draw_layout
from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision
from navigation.observation import Frame
from navigation.transform import yaw_rotation
from walking.command import HeadTarget, VelocityCommand
from walking.head import Head
from walking.odometry import Odometry
from walking.parameters import CONTROL_PERIOD
from walking.phase import Phase
from walking.state import Balance, HeadCameraPose, WalkingState

import numpy as np
from decision_world import TICK, Walker, World, perfect_belief
from numpy.typing import NDArray

Array = NDArray[np.float64]

NEAR = 0.6  # gap from the robot at which a mover is near [m]
UNKNOWN = 0.15  # distance of a mover from its nearest track at which it is not tracked [m]
CONTACT_TICKS = 2  # ticks between checks for contacts [1]
SETTLED = 1.0  # time after which the walking body bobs steadily [s]


@dataclass(frozen=True)
class Outcome:
    """Result of a run.

    Attributes:
        success: the goal was reached without a contact.
        contact: kind of the touched obstacle, "mover" or "static"; empty without a contact.
        time: of the end [s].
        clearance: minimum gap from an obstacle [m].
        near: time with a mover nearby [s].
        unaware: part of it without a track of the mover [s].
        head_travel: mean rate of the pan [rad/s].
        sharp: fraction of the frames that showed something [1].
        legs: fraction of the legs without a contact [1].
        detail: last contact, for people.
    """

    success: bool
    contact: str
    time: float
    clearance: float
    near: float
    unaware: float
    head_travel: float
    sharp: float
    legs: float
    detail: str = ""


class PlanarEngine:
    """Body that follows velocity commands in the plane, in place of the walking engine.

    Args:
        scenario: speeds, head and robot.
        start: pose (3,) [m, m, rad].
        rng: source of the slip.
    """

    down = False

    def __init__(self, scenario: Scenario, start: Array, rng: np.random.Generator) -> None:
        limits = scenario.speed_limits()
        self.body = Walker(start, limits, rng)
        self._footstep_ticks = max(1, round(limits.footstep / TICK))
        self._robot = load_robot(scenario.robot.model).model
        self._rest = self._robot.ready.copy()
        self._head = Head(self._robot, scenario.walking)
        self._offset = np.zeros(3)
        self._offset = camera_offset(self, scenario)
        self._covariance, self._ticks = np.zeros((3, 3)), 0
        self.steps = 0

    @property
    def yaw(self) -> float:
        """Heading in the odometry frame [rad]."""
        return float(self.body.odometry[2])

    def step(self, _: object, command: VelocityCommand, head: HeadTarget) -> None:
        """Advance by one tick."""
        for _ in range(round(TICK / CONTROL_PERIOD)):
            self._head.advance(head)
        if self._ticks % self._footstep_ticks == 0:
            self.body.latch(np.array(command.velocity))
            self.steps += 1
        self._ticks += 1
        self.body.step()
        x, y, yaw = self.body.odometry.tolist()
        c, s = cos(yaw), sin(yaw)
        to_odometry = np.array([[c, -s, y], [s, c, -x], [0.0, 0.0, 1.0]])
        noise = self.body.motion_covariance(TICK)
        self._covariance = self._covariance + to_odometry @ noise @ to_odometry.T

    def state(self) -> WalkingState:
        """Return the state that the decisions read."""
        pan, tilt = self._head.angles.tolist()
        pan_rate, tilt_rate = self._head.rates.tolist()
        rotation, position = self.camera_pose(pan, tilt)
        zero = np.zeros(2)
        x, y, yaw = self.body.odometry.tolist()
        return WalkingState(
            phase=Phase.DOUBLE_SUPPORT,
            odometry=Odometry(x, y, yaw, self._covariance),
            camera=HeadCameraPose(
                rotation=rotation,
                position=position,
                pan=pan,
                tilt=tilt,
                pan_rate=pan_rate,
                tilt_rate=tilt_rate,
                yaw_rate=self.body.yaw_rate,
            ),
            applied_velocity=self.body.body,
            footsteps=(),
            zmp=zero,
            dcm=zero,
            com=zero,
            roll=0.0,
            pitch=0.0,
            step_count=self.steps,
            fallen=False,
            balance=Balance(zero, zero, np.zeros((0, 2)), 0.0, np.zeros((2, 4)), zero),
        )

    def camera_pose(self, pan: float, tilt: float) -> tuple[Array, Array]:
        """Return rotation (3, 3) and position (3,) [m] of the camera in R."""
        joints = self._rest.copy()
        head = self._robot.tree.head
        if head is not None:
            joints[list(head)] = self._head.joints(pan, tilt)
        rotation, position = self._robot.frame_pose(self._robot.tree.camera, joints)
        return rotation, position + self._offset


_OFFSETS: dict[str, Array] = {}


def camera_offset(engine: PlanarEngine, scenario: Scenario) -> Array:
    """Return where the kinematic body carries its camera, relative to `engine` (3,) [m]."""
    if scenario.robot.model not in _OFFSETS:
        robot = scenario.robot.model_copy(update={"body": "kinematic"})
        camera = scenario.camera.model_copy(update={"source": "analytic"})
        scene = scenario.model_copy(update={"robot": robot, "camera": camera, "duration": 3.0})
        offsets = []
        with Simulation(scene, 0) as simulation:
            for tick in simulation:
                if tick.record is not None and tick.time > SETTLED:
                    camera_pose = tick.record.walking.camera
                    planar = engine.camera_pose(camera_pose.pan, camera_pose.tilt)[1]
                    offsets.append(camera_pose.position - planar)
        _OFFSETS[scenario.robot.model] = np.mean(offsets, axis=0)
    return _OFFSETS[scenario.robot.model]


class _Ahead:
    """Gaze straight ahead."""

    def choose(self, *_: object) -> GazeDecision:
        """Return the gaze."""
        return GazeDecision(pan=0.0, tilt=0.0)


class FastRun:
    """One run.

    Args:
        scenario: with robot.body and camera.source of any kind; a rendered camera becomes analytic.
        seed: of world and noise.
        exact: perfect sensing in place of camera and belief.
        planner: replaces the motion planner of the scenario.
        gaze: replaces the gaze planner of the scenario.
    """

    def __init__(
        self,
        scenario: Scenario,
        seed: int,
        *,
        exact: bool = False,
        planner: MotionPlanner | None = None,
        gaze: GazeController | None = None,
    ) -> None:
        self.layout = draw_layout(scenario, seed)
        self.world = World(self.layout)
        self.robot: Robot = build_robot(scenario, self.layout, seed, planner=planner, gaze=gaze)
        body_rng = named_rng(seed, "planar")
        self.engine = PlanarEngine(scenario, np.array(self.layout.start), body_rng)
        self.engine.body.odometry[:] = 0.0
        self.robot.walking = self.engine
        optics = head_camera(scenario)
        self._camera = AnalyticCamera(
            self.layout,
            optics,
            scenario.camera,
            named_rng(seed, "camera"),
            CameraFaults(()),
            fov=field_of_view(scenario, optics)[0],
            sight=camera_sight(scenario),
        )
        self._frame_ticks = max(1, round(1e-3 * scenario.camera.period_ms / TICK))
        self._ticks = round(scenario.duration / TICK)
        self._exact = None
        if exact:  # needs no gaze
            self._exact = build_decisions(
                scenario, self.layout, seed, None, planner=planner, gaze=_Ahead()
            )
        self._near = self._unaware = self._travel = 0.0
        self._frames = self._sharp = 0
        self._pan, self._leg = 0.0, 0

    def run(self) -> Outcome:
        """Walk until the goal, a contact or the time limit."""
        world, body, first_mover = self.world, self.engine.body, len(self.layout.static)
        clearance, contact, detail, done, time = 9.0, "", "", False, TICK
        for tick in range(self._ticks):
            time = (tick + 1) * TICK
            frame = tick % self._frame_ticks == 0
            self.robot.walk(SensorFrame(time, None, shutter=frame and self._exact is None))
            if frame and (self._see(time) if self._exact is None else self._decide(time)):
                done = True
                break
            if tick % CONTACT_TICKS:
                continue
            gaps = world.gaps(time, body.pose)
            clearance = min(clearance, float(gaps.min(initial=9.0)))
            if frame:
                self._watch(gaps, time)
            if clearance < 0.0:
                touched = int(gaps.argmin())
                contact = "mover" if touched >= first_mover else "static"
                detail = self._describe(touched, time)
                break
        return Outcome(
            success=done,
            contact=contact,
            time=round(time, 2),
            clearance=round(clearance, 4),
            near=round(self._near, 2),
            unaware=round(self._unaware, 2),
            head_travel=round(self._travel / time, 3),
            sharp=round(self._sharp / max(1, self._frames), 3),
            legs=1.0 if done else round(self._leg / len(self.layout.waypoints), 3),
            detail=detail,
        )

    def _see(self, time: float) -> bool:
        """Perceive and decide as the robot does; return whether the mission is done."""
        x, y, heading = self.engine.body.pose.tolist()
        turn, camera = yaw_rotation(heading), self.engine.state().camera
        detections = self._camera.detect(
            time,
            (x, y, wrap(heading)),
            turn @ camera.position + (x, y, 0.0),
            turn @ camera.rotation,
        )
        sensed = SensorFrame(time, None, captured=time, detections=detections)
        if (situation := self.robot.perceive(sensed)) is not None:
            self.robot.decide(situation)
        frame = self.robot.frame
        assert frame is not None
        pan = frame.measured.view.pan
        self._travel += abs(pan - self._pan)
        self._pan = pan
        self._frames += 1
        self._sharp += not frame.measured.view.blind
        self._leg = frame.task.index
        return frame.task.done

    def _decide(self, time: float) -> bool:
        """Decide with perfect sensing; return whether the mission is done."""
        assert self._exact is not None
        odometry, pose = self.engine.body.odometry.copy(), self.engine.body.pose
        belief = perfect_belief(time, np.array([*pose[:2], wrap(float(pose[2]))]), self.world)
        frame = Frame(time, odometry, np.zeros((3, 3)), belief.view, ())
        context = DecisionContext(time, odometry, belief.view, self.engine.steps)
        decision = self._exact.make(belief, frame, context)
        self.robot.command = VelocityCommand(*decision.motion.velocity.tolist())
        self._leg = decision.task.index
        return decision.task.done

    def _watch(self, gaps: Array, time: float) -> None:
        """Count the time with movers nearby, and without their tracks."""
        first = len(self.layout.static)
        near = np.flatnonzero(gaps[first:] < NEAR) + first
        if len(near) == 0 or self.robot.frame is None:
            return
        period = self._frame_ticks * CONTACT_TICKS * TICK
        positions = self.world.state(time)[0][near]
        self._near += period * len(near)
        unaware = [
            _nearest(self.robot.frame.belief, position)[0] > UNKNOWN for position in positions
        ]
        self._unaware += period * sum(unaware)

    def _describe(self, touched: int, time: float) -> str:
        """Return bearing, speeds and track of the obstacle that the body touches, for people."""
        body, frame = self.engine.body, self.robot.frame
        position, velocity = (a[touched] for a in self.world.state(time))
        dx, dy = (position - body.pose[:2]).tolist()
        bearing = degrees(wrap(atan2(dy, dx) - float(body.pose[2])))
        track = "exact" if frame is None else _nearest(frame.belief, position)[1]
        speeds = f"{hypot(*velocity.tolist()):.2f}, robot {hypot(*body.body[:2].tolist()):.2f} m/s"
        return f"obstacle {touched} at {bearing:.0f} deg, {speeds}, {track}"


def _nearest(belief: Belief, position: Array) -> tuple[float, str]:
    """Return distance and description of the track nearest to a position in W [m]."""
    tracks = belief.tracks
    if not tracks:
        return inf, "no track"
    gaps = [hypot(*(track.position - position).tolist()) for track in tracks]
    k = int(np.argmin(gaps))
    track = tracks[k]
    return gaps[
        k
    ], f"track off {gaps[k]:.2f} m, age {track.age:.2f} s, {track.motion}, {track.hits}"
