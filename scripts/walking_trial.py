"""A walk of the engine in full physics, and the commands that it is given."""

import dataclasses
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from walking.command import HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD, WalkingParameters

import numpy as np
from walking_body import Body

SAMPLE = 4  # ticks between two rows of a trace
SAMPLE_TIME = SAMPLE * CONTROL_PERIOD
BOX = ((-0.4, 0.4), (-0.15, 0.15), (-2.0, 2.0))  # vx, vy [m/s], wz [rad/s]

Script = Callable[[float], tuple[VelocityCommand, HeadTarget]]


@dataclass
class Trace:
    """Records of a walk, one row every `SAMPLE` ticks."""

    tilt: list[float] = field(default_factory=list)
    truth: list[np.ndarray] = field(default_factory=list)
    odometry: list[tuple[float, float, float]] = field(default_factory=list)
    steps: list[int] = field(default_factory=list)
    camera_error: list[np.ndarray] = field(default_factory=list)
    falls: list[float] = field(default_factory=list)
    self_contacts: int = 0
    ticks: int = 0
    cpu_engine: float = 0.0
    cpu_physics: float = 0.0

    @property
    def footsteps(self) -> int:
        """Footsteps made, those before a fall among them."""
        return int(np.maximum(0, np.diff(self.steps)).sum())

    def sample(self, body: Body, engine: WalkingEngine) -> None:
        """Note where the body is and where the engine believes it to be."""
        state = engine.state()
        odometry, camera = state.odometry, state.camera
        self.tilt.append(float(np.degrees(np.arccos(min(1.0, body.up)))))
        self.truth.append(body.pose)
        self.odometry.append((odometry.x, odometry.y, odometry.yaw))
        self.steps.append(state.step_count)
        self.self_contacts += body.self_contact
        self.camera_error.append(body.camera_error(camera.rotation, camera.position))


def walk(
    engine_of: Callable[[], WalkingEngine],
    body_of: Callable[[], Body],
    script: Script,
    duration: float,
) -> Trace:
    """Walk a script; after a fall a fresh robot goes on."""
    trace = Trace()
    body, engine = body_of(), engine_of()
    for tick in range(round(duration / CONTROL_PERIOD)):
        now = tick * CONTROL_PERIOD
        command, head = script(now)
        sensors = body.sense()
        start = time.process_time()
        targets = engine.step(sensors, command, head)
        trace.cpu_engine += time.process_time() - start
        if tick % SAMPLE == 0:
            trace.sample(body, engine)
        start = time.process_time()
        body.apply(targets.setpoint)
        trace.cpu_physics += time.process_time() - start
        trace.ticks += 1
        if body.fallen:
            trace.falls.append(now)
            body, engine = body_of(), engine_of()
    return trace


def random_script(seed: int) -> Script:
    """A new command of the box every 0.5 to 2 s, stops, extremes, and a head that saccades."""
    rng = np.random.default_rng([seed, 7])
    schedule: list[tuple[float, VelocityCommand]] = []
    now = 0.0
    while now < 4000.0:
        draw = rng.uniform()
        values = [rng.uniform(*side) for side in BOX]
        if draw < 0.15:
            values = [0.0, 0.0, 0.0]
        elif draw < 0.3:
            values = [side[rng.integers(2)] for side in BOX]
        schedule.append((now, VelocityCommand(*map(float, values))))
        now += rng.uniform(0.5, 2.0)
    gaze = rng.uniform((-1.5, -0.8), (1.5, 0.2), (20000, 2)).tolist()
    state = {"next": 0, "command": VelocityCommand()}

    def script(now: float) -> tuple[VelocityCommand, HeadTarget]:
        if state["next"] < len(schedule) and schedule[state["next"]][0] <= now:
            state["command"] = schedule[state["next"]][1]
            state["next"] += 1
        pan, tilt = gaze[int(now / 0.2) % len(gaze)]
        return state["command"], HeadTarget(pan, tilt)

    return script


def steady_script(command: VelocityCommand) -> Script:
    """One command for ever."""
    return lambda _now: (command, HeadTarget())


def parameters_of(settings: list[str]) -> WalkingParameters:
    """Default parameters with `group.name=value` settings."""
    parameters = WalkingParameters()
    for setting in settings:
        key, text = setting.split("=")
        group, name = key.split(".")
        section = getattr(parameters, group)
        value = type(getattr(section, name))(text)
        section = dataclasses.replace(section, **{name: value})
        parameters = dataclasses.replace(parameters, **{group: section})
    return parameters
