"""The closed loop: world, sensors, robot, and back, one control tick after the other."""

import hashlib
from collections.abc import Callable, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass

from hsr8.body_builder import build_body, build_model
from hsr8.errors import SimulationDiverged
from hsr8.recorder.record import FrameRecord, Listener, TickRecord
from hsr8.recorder.tape import TapeWriter
from hsr8.robot import SensorFrame
from hsr8.robot_builder import build_robot, head_camera
from hsr8.scenario.schema import Scenario
from hsr8.seeds import named_rng
from hsr8.world.analytic import AnalyticCamera
from hsr8.world.body import Body
from hsr8.world.camera import RenderedCamera
from hsr8.world.camera_feed import CameraFeed, Picture
from hsr8.world.episodes import Episodes
from hsr8.world.falls import Falls
from hsr8.world.generator import draw_layout
from hsr8.world.index import ModelIndex
from hsr8.world.physics import CONTROL_PERIOD
from hsr8.world.truth import Truth
from walking.state import Phase

GOAL_DWELL = 1.0  # the run goes on for so long after the goal is reached [s]
TICKS_A_SECOND = round(1.0 / CONTROL_PERIOD)
FALL_DWELL = 0.6  # and for so long after a fall for good, so that it can be seen [s]


@dataclass(frozen=True, slots=True)
class RunOutcome:
    """How a run ended.

    Attributes:
        exit_reason: goal, timeout, completed, fall, diverged or interrupted.
        time: simulated time at the end [s].
        state_hash: SHA-256 of the world's state and the robot's belief.
    """

    exit_reason: str
    time: float
    state_hash: str


class Simulation:
    """One run of one scenario with one seed.

    Args:
        scenario: what to run.
        seed: draws the world and every noise.
        listeners: told of every record; they never change the run.

    Raises:
        ScenarioError: the world cannot be drawn as asked.
        RenderingUnavailable: the camera needs OpenGL and there is none.
    """

    def __init__(self, scenario: Scenario, seed: int, listeners: Sequence[Listener] = ()) -> None:
        self.scenario = scenario
        self.seed = seed
        self.listeners = list(listeners)
        self.tape: TapeWriter | None = None
        self.layout = draw_layout(scenario, seed)
        self.model = build_model(scenario, self.layout)
        self._body = build_body(scenario, seed, self.layout, self.model)
        self._robot = build_robot(scenario, self.layout, seed)
        self._watch = _EventWatch(self._tell)
        self._interrupted = False
        self._rendered: RenderedCamera | None = None
        self._analytic: AnalyticCamera | None = None
        self._camera_rng = named_rng(seed, "camera")
        camera = scenario.camera
        if camera.source != "egl":
            self._analytic = AnalyticCamera(
                self.layout, head_camera(scenario), self._camera_rng, scenario.camera
            )
        self._feed = CameraFeed(camera, self._take, named_rng(seed, "camera_feed"))

    @property
    def index(self) -> ModelIndex:
        """Addresses in the model."""
        return ModelIndex.of(self.model, len(self.layout.static), len(self.layout.movers))

    def interrupt(self) -> None:
        """Ask the run to end after the present tick."""
        self._interrupted = True

    def run(self) -> RunOutcome:
        """Run to the end and close the listeners.

        Raises:
            SimulationDiverged: the physics blew up; the listeners are closed first.
        """
        reason = "error"
        with ExitStack() as stack:
            if self._analytic is None:
                self._rendered = stack.enter_context(
                    closing(RenderedCamera(self.model, self.scenario.camera, self._camera_rng))
                )
            try:
                reason = self._ticks()
            except SimulationDiverged as error:
                reason = "diverged"
                self._tell("diverged", str(error))
                raise
            except KeyboardInterrupt:
                reason = "interrupted"
            finally:
                with ExitStack() as farewell:  # each is closed, also when another one fails
                    if self.tape is not None:
                        farewell.callback(self.tape.close)
                    for listener in reversed(self.listeners):
                        farewell.callback(listener.close, reason)
        return RunOutcome(reason, self._body.time, self.state_hash())

    def state_hash(self) -> str:
        """SHA-256 of the world's state and the robot's belief."""
        return hashlib.sha256(self._body.state_bytes() + self._believed()).hexdigest()

    def _believed(self) -> bytes:
        """All numbers of the pose and the tracks the robot believes in."""
        if self._robot.frame is None:
            return b""
        belief = self._robot.frame.belief
        parts = [belief.pose, belief.pose_covariance]
        for track in belief.tracks:
            parts += (track.position, track.covariance)
        return b"".join(part.tobytes() for part in parts)

    def _mark(self, tick: int) -> None:
        """Hash of everything, once a second and at the end."""
        if self.tape is not None:
            self.tape.mark(tick, self._body.state_bytes(), self._believed())

    def _ticks(self) -> str:
        scenario = self.scenario
        record_ticks = round(scenario.recorder.period_ms / 1000 / CONTROL_PERIOD)
        last = round(scenario.duration / CONTROL_PERIOD)
        end: tuple[int, str] | None = None
        published: FrameRecord | None = None
        for tick in range(last + 1):
            if tick % TICKS_A_SECOND == 0:
                self._mark(tick)
            sensed = self._sense(tick)
            targets = self._robot.step(sensed)
            if tick % record_ticks == 0:
                truth = self._body.truth()
                frame = self._robot.frame
                self._publish(tick, truth, frame if frame is not published else None)
                published = frame
                end = end or self._ending(tick, truth)
            if self._interrupted or (end is not None and tick >= end[0]):
                break
            if self.tape is not None:
                self.tape.add(self._body.set_points(targets))
            self._body.apply(targets)
        else:
            tick = last + 1
        self._mark(tick)
        if self._interrupted:
            return "interrupted"
        if end is not None and tick >= end[0]:
            return end[1]
        finite = len(self.layout.waypoints) > 0 and not self.layout.endless
        return "timeout" if finite else "completed"

    def _sense(self, tick: int) -> SensorFrame:
        body, time = self._body.sense(), self._body.time
        shutter, picture = self._feed.shutter(tick), self._feed.arrived(tick, self._body)
        if picture is None:
            return SensorFrame(time, body, shutter)
        return SensorFrame(time, body, shutter, picture.captured, picture.image, picture.detections)

    def _take(self, body: Body) -> Picture:
        if self._rendered is not None:
            return Picture(body.time, image=self._rendered.capture(body))
        assert self._analytic is not None
        return Picture(body.time, detections=self._analytic.capture(body))

    def _ending(self, tick: int, truth: Truth) -> tuple[int, str] | None:
        """Tick and reason of an end that is now decided."""
        if truth.fallen and self._stays_down():
            return tick + round(FALL_DWELL / CONTROL_PERIOD), "fall"
        frame = self._robot.frame
        if frame is not None and frame.task.done:
            return tick + round(GOAL_DWELL / CONTROL_PERIOD), "goal"
        return None

    def _stays_down(self) -> bool:
        """Whether a fallen robot does not try to get up, or no longer."""
        if not self.scenario.walking_parameters().get_up.enabled:
            return True
        return self._robot.walking_state().phase is Phase.FALLEN

    def _publish(self, tick: int, truth: Truth, frame: FrameRecord | None) -> None:
        self._watch.look(truth, frame)
        record = TickRecord(
            tick=tick,
            time=self._body.time,
            truth=truth,
            walking=self._robot.walking_state(),
            tally=self._robot.tally,
            command=self._robot.command,
            head=self._robot.head,
            frame=frame,
        )
        for listener in self.listeners:
            listener.on_record(record)

    def _tell(self, kind: str, text: str, time: float | None = None) -> None:
        for listener in self.listeners:
            listener.on_event(self._body.time if time is None else time, kind, text)


class _EventWatch:
    """Turns records into events."""

    def __init__(self, tell: Callable[..., None]) -> None:
        self._tell = tell
        self._pushes = 0
        self._episodes = Episodes()
        self._falls = Falls()
        self._index = 0
        self._lost = False
        self._done = False

    def look(self, truth: Truth, frame: FrameRecord | None) -> None:
        """Tell what changed since the last record."""
        for push in truth.pushes:
            if push.number >= self._pushes:
                self._pushes = push.number + 1
                self._tell("push", push.text(), push.begin)
        if self._falls.add(truth.time, fallen=truth.fallen):
            self._tell("fall", "the robot has fallen")
        for collision in self._episodes.add(truth.time, truth.contacts):
            what = "mover" if collision.moving else "obstacle"
            self._tell("collision", f"{collision.robot_geom} touches {what} {collision.obstacle}")
        if frame is None:
            return
        if frame.task.index > self._index:
            self._index = frame.task.index
            self._tell("via_point", f"via point {self._index} passed")
        if frame.task.done and not self._done:
            self._done = True
            self._tell("goal", "goal reached")
        if frame.belief.lost != self._lost:
            self._lost = frame.belief.lost
            self._tell(
                *(("lost", "localization is lost") if self._lost else ("found", "localized again"))
            )
