"""Closed loop of world and robot, one control tick at a time."""

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from time import perf_counter
from typing import Self, SupportsIndex

import cv2
import numpy as np

from hsr8.errors import ScenarioError, SimulationDiverged
from hsr8.plugins.decisions import GazePlugin, PlannerPlugin
from hsr8.plugins.method import number
from hsr8.plugins.walker import CustomWalker
from hsr8.robots.loaded import load_robot
from hsr8.scenario.schema import Scenario
from hsr8.simulation.controller import SensorFrame
from hsr8.simulation.decisions import FrameRecord, Situation
from hsr8.simulation.drive import Drive
from hsr8.simulation.record import Event, EventWatch, RunOutcome, Second, Tick, TickRecord
from hsr8.simulation.robot_builder import (
    build_body,
    build_model,
    build_robot,
    camera_model,
    require_planner,
)
from hsr8.world.body.faults import SensorFaults, ServoFaults
from hsr8.world.camera.head_camera import HeadCamera
from hsr8.world.field.generator import draw_world
from hsr8.world.truth.truth import Truth
from navigation.decision import GazeDecision, MotionDecision
from walking.parameters import CONTROL_PERIOD
from walking.state import JointTargets, Phase

GOAL_DWELL = 1.0  # simulated time after the goal is reached [s]
FALL_DWELL = 0.6  # simulated time after the final fall, so that it is visible [s]
HASH = 16  # bytes of a hash
TICKS_PER_SECOND = round(1.0 / CONTROL_PERIOD)


@dataclass(slots=True)
class _BegunTick:
    """Control tick in which the robot has walked and perceived, but not yet decided.

    Attributes:
        seconds: states with hashes at its start.
        sensed: sensor readings.
        targets: setpoints of the walking engine.
        walking_time: wall time of the walking engine [s].
        situation: situation that the robot decides in; None without a decision.
        motion, gaze: decisions that replace those of the robot.
    """

    seconds: list[Second]
    sensed: SensorFrame
    targets: JointTargets
    walking_time: float
    situation: Situation | None
    motion: MotionDecision | None = None
    gaze: GazeDecision | None = None


@contextmanager
def _building(scenario: Scenario) -> Iterator[None]:
    """Convert errors of parameters that do not fit together into a `ScenarioError`."""
    try:
        yield
    except (ValueError, ArithmeticError, MemoryError) as error:
        raise ScenarioError(
            f"scenario {scenario.name!r}: invalid parameters in walking, vision, belief or "
            f"navigation: {error}"
        ) from error


class Simulation:
    """Run of one scenario with one seed.

    As a whole: ``outcome = Simulation(scenario, seed).run()``. Tick by tick:

        with Simulation(scenario, seed) as simulation:
            for tick in simulation:
                ...

    Args:
        scenario: what to run.
        seed: seed of the world and of all noise; default: that of the scenario.
        planner: replaces the motion planner of the scenario.
        gaze: replaces the gaze planner of the scenario.
        walker: replaces the walking engine of the scenario.
        drive: commands from outside, which replace the planner and, once one is given, the gaze.

    Attributes:
        scenario: what to run.
        seed: seed of the world and of all noise.
        humanoid: the robot and its model.
        layout: the drawn world.
        certificate: feasibility certificate of the world.
        model: MuJoCo model of world and robot.
        exit_reason: goal, timeout, completed, fall, diverged or interrupted after the run; None
            before.
        tick: control ticks made so far.
        truth: ground truth of the latest record; None before the first tick.

    Raises:
        ScenarioError: the seed is invalid, or the world cannot be drawn.
        ModelError: the robot or field model is missing or invalid.
        UsageError: the planner, gaze or walker, given or named by the scenario, is invalid.
        RenderingUnavailable: in ``with`` or `run`: the camera needs OpenGL, which is missing.
    """

    def __init__(
        self,
        scenario: Scenario,
        seed: SupportsIndex | None = None,
        *,
        planner: PlannerPlugin | None = None,
        gaze: GazePlugin | None = None,
        walker: CustomWalker | None = None,
        drive: Drive | None = None,
    ) -> None:
        self.scenario = scenario
        self.seed = scenario.seed if seed is None else scenario.with_seed(seed).seed
        self.humanoid = load_robot(scenario.robot.model)
        world = draw_world(scenario, self.seed)
        self.layout, self.certificate = world.layout, world.certificate
        self.model = build_model(scenario, self.layout)
        self.exit_reason: str | None = None
        self.tick = 0
        self.truth: Truth | None = None
        self._begun: _BegunTick | None = None
        self._body = build_body(scenario, self.seed, self.layout, self.model)
        self._drive = drive
        with _building(scenario):
            self._robot = build_robot(
                scenario,
                self.layout,
                self.seed,
                planner=planner,
                gaze=gaze,
                walker=walker,
                drive=drive,
            )
        self._watch = EventWatch(scenario.fault)
        names = self.humanoid.model.names
        self._sensor_faults = SensorFaults(scenario.fault, names)
        self._servo_faults = ServoFaults(scenario.fault, names)
        self._camera = HeadCamera(
            scenario, self.model, self.layout, camera_model(scenario, self.layout.sizes), self.seed
        )
        self._interrupted = self._open = False
        self._record_ticks = round(scenario.recorder.period_ms / 1000 / CONTROL_PERIOD)
        self._ticks = round(scenario.duration / CONTROL_PERIOD) + 1
        self._end: tuple[int, str] | None = None
        self._published: FrameRecord | None = None
        self._not_sent = np.full(len(names), np.nan)

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._body.time

    def interrupt(self) -> None:
        """End the run after the present tick."""
        self._interrupted = True

    def __enter__(self) -> Self:
        self._threads = cv2.getNumThreads()
        cv2.setNumThreads(1)  # threads slow down work on small images
        try:
            self._camera.open()
        except BaseException as error:  # sets the exit reason
            self.__exit__(type(error), error, None)
            raise
        self._open = True
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        """Close the camera."""
        self._open = False
        if self.exit_reason is None:
            stopped = kind is None or issubclass(kind, KeyboardInterrupt)
            self.exit_reason = "interrupted" if stopped else "error"
        self._camera.close()
        cv2.setNumThreads(self._threads)

    def run(self) -> RunOutcome:
        """Run to the end."""
        with suppress(KeyboardInterrupt), self:
            for _ in self:
                pass
        return self.outcome()

    def outcome(self) -> RunOutcome:
        """Return the outcome of the run.

        Raises:
            RuntimeError: the run has not ended.
        """
        if self.exit_reason is None:
            raise RuntimeError("the run has not ended: call step() until `exit_reason` is set")
        return RunOutcome(self.exit_reason, self._body.time, self.state_hash())

    def __iter__(self) -> Iterator[Tick]:
        """Yield the control ticks until the run ends."""
        while self.exit_reason is None:
            yield self.step()

    def step(self) -> Tick:
        """Make one control tick.

        Raises:
            RuntimeError: the run has ended, or ``with`` is missing.
        """
        with self._running("step"):
            begun, self._begun = self._begun or self._begin(), None
            return self._complete(begun)

    def perceive(self) -> Situation | None:
        """Begin a control tick and return the situation to decide in; None without a frame.

        `step` decides and completes the tick; `look` and `command` in between replace decisions.

        Raises:
            RuntimeError: the run has ended, or ``with`` is missing.
        """
        with self._running("perceive"):
            self._begun = self._begun or self._begin()
            return self._begun.situation

    def look(self, pan: float, tilt: float) -> None:
        """Replace the gaze of this frame, after `perceive` and before `step`.

        Args:
            pan: left positive [rad]; the neck limits both angles.
            tilt: up positive [rad].

        Raises:
            RuntimeError: `perceive` returned no situation.
            UsageError: an angle is not a finite number.
        """
        begun, _ = self._undecided("look")
        begun.gaze = GazeDecision(number(pan, "pan", "look"), number(tilt, "tilt", "look"))

    def command(self, vx: float, vy: float, wz: float) -> None:
        """Replace the motion of this footstep, after `perceive` and before `step`.

        Args:
            vx: forward [m/s].
            vy: velocity to the left [m/s].
            wz: yaw rate, counter-clockwise positive [rad/s].

        Raises:
            RuntimeError: `perceive` returned no situation in which a motion is due.
            UsageError: a velocity is not a finite number, or the mission is a walk.
        """
        require_planner(self.scenario)
        begun, situation = self._undecided("command")
        if not situation.motion_due:
            raise RuntimeError("command: no motion is due; expected situation.motion_due")
        values = {"vx": vx, "vy": vy, "wz": wz}
        velocity = [number(value, key, "command") for key, value in values.items()]
        begun.motion = MotionDecision(velocity=np.array(velocity))

    def _undecided(self, method: str) -> tuple[_BegunTick, Situation]:
        begun = self._begun
        if begun is None:
            raise RuntimeError(f"{method}: the tick has not begun; expected perceive() before")
        if begun.situation is None:
            raise RuntimeError(
                f"{method}: no decision is pending; expected a tick in which perceive() returned "
                "a situation"
            )
        return begun, begun.situation

    @contextmanager
    def _running(self, method: str) -> Iterator[None]:
        """Require a run that goes on, and add the simulated time to errors."""
        if not self._open or self.exit_reason is not None:
            reason = "the run has ended" if self.exit_reason else "enter `with simulation:` first"
            raise RuntimeError(f"{method}: {reason}")
        try:
            yield
        except Exception as error:
            error.add_note(f"at {self._body.time:.3f} s of simulated time")
            raise

    def state_hash(self) -> str:
        """Return the SHA-256 of the state of the world and the belief of the robot."""
        return hashlib.sha256(self._body.state_bytes() + self._robot.belief_bytes()).hexdigest()

    def _mark(self) -> Second:
        """Return the hashes of the state."""
        world, belief = self._body.state_bytes(), self._robot.belief_bytes()
        state = hashlib.blake2b(world, digest_size=HASH)
        digest = state.digest()
        state.update(belief)
        return Second(self.tick, self._body.time, digest, state.digest(), self._body.saturation())

    def _begin(self) -> _BegunTick:
        seconds = [self._mark()] if self.tick % TICKS_PER_SECOND == 0 else []
        sensed = self._sense(self.tick)
        started = perf_counter()
        targets = self._robot.walk(sensed)
        walking_time = perf_counter() - started
        situation = self._robot.perceive(sensed)
        if self.tick % self._record_ticks == 0:
            self.truth = self._body.truth()
        return _BegunTick(seconds, sensed, targets, walking_time, situation)

    def _complete(self, begun: _BegunTick) -> Tick:
        number, seconds = self.tick, begun.seconds
        if begun.situation is not None:
            self._robot.decide(begun.situation, begun.motion, begun.gaze)
        walker, setpoint = self._robot.walking, self._not_sent
        record, events = self._record(number)
        reason = self._reason(number)
        if not reason:
            targets = self._servo_faults.apply_fault(begun.targets, number)
            setpoint = self._body.setpoints(targets).copy()
            reason, diverged = self._apply(targets)
            events += diverged
        if reason:
            self.exit_reason = reason
            seconds.append(self._mark())
        return Tick(
            number=number,
            time=begun.sensed.time,
            sensors=begun.sensed.body,
            setpoint=setpoint,
            limits=walker.limits,
            zmp_depth=float(walker.zmp_depth),
            down=walker.down,
            walking_time=begun.walking_time,
            record=record,
            seconds=tuple(seconds),
            events=tuple(events),
            commands=() if self._drive is None else self._drive.take(),
        )

    def _record(self, number: int) -> tuple[TickRecord | None, list[Event]]:
        """Return the record that is due in this tick, if any, and the events."""
        truth = self.truth
        if truth is None or number % self._record_ticks:
            return None, []
        frame = self._robot.frame if self._robot.frame is not self._published else None
        self._published = self._robot.frame
        self._end = self._end or self._scheduled_end(number, truth)
        events = list(self._watch.look(truth, frame))
        record = TickRecord(
            tick=number,
            time=self._body.time,
            truth=truth,
            walking=self._robot.walking_state(),
            command=self._robot.command,
            head=self._robot.head,
            frame=frame,
        )
        return record, events

    def _reason(self, number: int) -> str:
        """Return the reason to end before this tick is applied, empty for none."""
        if self._interrupted:
            return "interrupted"
        return self._end[1] if self._end is not None and number >= self._end[0] else ""

    def _apply(self, targets: JointTargets) -> tuple[str, list[Event]]:
        """Advance the world; return the reason to end afterwards, empty for none, and events."""
        try:
            self._body.apply(targets)
        except SimulationDiverged as error:
            return "diverged", [Event(self._body.time, "diverged", str(error))]
        self.tick += 1
        if self.tick < self._ticks:
            return "", []
        finite = len(self.layout.waypoints) > 0 and not self.layout.endless
        return "timeout" if finite else "completed", []

    def _sense(self, tick: int) -> SensorFrame:
        body, time = self._sensor_faults.apply_fault(self._body.sense(), tick), self._body.time
        shutter, frame = self._camera.shutter(tick), self._camera.arrived(tick, self._body)
        if frame is None:
            return SensorFrame(time, body, shutter)
        return SensorFrame(time, body, shutter, frame.captured, frame.image, frame.detections)

    def _scheduled_end(self, tick: int, truth: Truth) -> tuple[int, str] | None:
        """Return tick and reason of the end once it is certain."""
        if truth.fallen and self._stays_down():
            return tick + round(FALL_DWELL / CONTROL_PERIOD), "fall"
        frame = self._robot.frame
        if frame is not None and frame.task.done:
            return tick + round(GOAL_DWELL / CONTROL_PERIOD), "goal"
        return None

    def _stays_down(self) -> bool:
        """Return whether a fallen robot does not try to get up, or has given up."""
        gets_up = self.scenario.walking.get_up.enabled
        return not gets_up or self._robot.walking_state().phase is Phase.FALLEN
