"""Ticks, records and events that the loop returns."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from hsr8.scenario.fault import Fault
from hsr8.simulation.decisions import DriveCommand, FrameRecord
from hsr8.world.truth.saturation import Saturation
from hsr8.world.truth.truth import CollisionCounter, Falls, Truth
from walking.command import Command, HeadTarget, Limit
from walking.state import BodySensors, WalkingState

SAME_TIME = 1e-6  # times closer than this are equal [s]


class Event(NamedTuple):
    """Event with its time [s]."""

    time: float
    kind: str
    text: str


@value
class TickRecord:
    """State of the run, returned once per record period (20 ms by default).

    Attributes:
        tick: number of the control tick.
        time: simulated time [s].
        truth: state of the world.
        walking: state of the walking engine.
        command: commanded velocity or footsteps.
        head: commanded gaze.
        frame: camera frame that arrived since the last record, if any.
    """

    tick: int
    time: float
    truth: Truth
    walking: WalkingState
    command: Command
    head: HeadTarget
    frame: FrameRecord | None


@value
class Second:
    """State of the run, returned once per second and at the end.

    Attributes:
        tick: number of the next control tick.
        time: simulated time [s].
        world: hash of the state of the world.
        robot: hash of the state of the world and the belief of the robot.
        saturation: saturation of the servos so far; None of a body without dynamics.
    """

    tick: int
    time: float
    world: bytes
    robot: bytes
    saturation: Saturation | None


@value
class Tick:
    """One control tick.

    Attributes:
        number: number of the tick.
        time: simulated time at its start [s].
        sensors: readings that the robot received.
        setpoint: sent to the servos; NaN in the last tick (joints,) [rad].
        limits: constraints that limited the command.
        zmp_depth: distance of the planned ZMP from the edge of the soles, negative outside [m].
        down: whether the robot lies or gets up.
        walking_time: wall time of the walking engine [s].
        record: state of the run, if one is due.
        seconds: states with hashes: at the start of every second and at the end of the run.
        events: since the previous tick.
        commands: commands from outside since the previous tick.
    """

    number: int
    time: float
    sensors: BodySensors
    setpoint: NDArray[np.float64]
    limits: tuple[Limit, ...]
    zmp_depth: float
    down: bool
    walking_time: float
    record: TickRecord | None
    seconds: tuple[Second, ...]
    events: tuple[Event, ...]
    commands: tuple[DriveCommand, ...]


@dataclass(frozen=True, slots=True)
class RunOutcome:
    """Outcome of a run.

    Attributes:
        exit_reason: goal, timeout, completed, fall, diverged or interrupted.
        time: simulated time at the end [s].
        state_hash: SHA-256 of the state of the world and the belief of the robot.
    """

    exit_reason: str
    time: float
    state_hash: str


class EventWatch:
    """Turns records into events.

    Args:
        faults: faults of the scenario.
    """

    def __init__(self, faults: Sequence[Fault]) -> None:
        events = [(f.begin, f"{f.text()}: begins") for f in faults]
        events += [(f.end, f"{f.text()}: ends") for f in faults if f.end is not None]
        self._faults = sorted(events, key=lambda event: event[0])
        self._pushes = 0
        self._collisions = CollisionCounter()
        self._falls = Falls()
        self._index = 0
        self._lost = False
        self._done = False

    def look(self, truth: Truth, frame: FrameRecord | None) -> Iterator[Event]:
        """Yield the events since the last record; exhaust the iterator."""
        now = truth.time
        while self._faults and self._faults[0][0] <= now + SAME_TIME:
            time, text = self._faults.pop(0)
            yield Event(time, "fault", text)
        for push in truth.pushes:
            if push.number >= self._pushes:
                self._pushes = push.number + 1
                yield Event(push.begin, "push", push.text())
        if self._falls.add(now, fallen=truth.fallen):
            yield Event(now, "fall", "the robot has fallen")
        for collision in self._collisions.add(now, truth.contacts):
            text = f"{collision.robot_geom} touches {collision.name}"
            yield Event(now, "collision", text)
        if frame is None:
            return
        if frame.task.index > self._index:
            self._index = frame.task.index
            yield Event(now, "via_point", f"via point {self._index} passed")
        if frame.task.done and not self._done:
            self._done = True
            yield Event(now, "goal", "goal reached")
        if frame.belief.lost != self._lost:
            self._lost = frame.belief.lost
            if self._lost:
                yield Event(now, "lost", "localization is lost")
            else:
                yield Event(now, "relocalized", "localized again")
