"""Live topics of a run: what each tick hands to the publishing process, and takes from it."""

import multiprocessing
import select
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import partial
from importlib.util import find_spec
from typing import Any, Self

from hsr8.errors import UsageError
from hsr8.export.bag import require_rosbags
from hsr8.export.topics import PIXELS, START, TOPICS, Setup
from hsr8.recording.columns import Column
from hsr8.recording.recorded import FrameSampler
from hsr8.recording.rows import TABLES
from hsr8.robots.loaded import LoadedRobot
from hsr8.ros.inputs import Command
from hsr8.ros.outbox import Outbox
from hsr8.ros.process import Network, serve
from hsr8.simulation.decisions import DriveCommand
from hsr8.simulation.drive import TIMEOUT, Drive
from hsr8.simulation.record import Tick, TickRecord

BACKLOG = 400  # ticks that wait for the publishing process; further ones are dropped
STARTUP, LEAVING = 60.0, 5.0  # wall-clock limits of the start and the end of the process [s]

Row = tuple[str, Mapping[str, Any]]
"""Table and values by column."""


class LiveTopics:
    """Topics of a run in a process that publishes them: a context for the run.

    Args:
        network: domain and endpoints.
        setup: constants of the run.
        robot: the robot.
        scale: scale of the world [1].
        drive: receives commands; None for none.

    Raises:
        UsageError: the extra is not installed; in ``with``: an endpoint is taken or invalid.
    """

    def __init__(
        self,
        network: Network,
        setup: Setup,
        robot: LoadedRobot,
        *,
        scale: float = 1.0,
        drive: Drive | None = None,
    ) -> None:
        self._drive, self._model = drive, robot.model
        self._posture = robot.model.ready.copy()
        self._sampler = FrameSampler(scale)
        self._getters = {table: _getters(table) for table in ("ticks", "frames", "records")}
        self._published: int | None = None  # known at the end
        self._dropped = 0
        self._gone = False
        self._warned: set[str] = set()
        self._driven_at: float | None = None  # time of the velocity in force [s]
        spawn = multiprocessing.get_context("spawn")
        ticks, outgoing = spawn.Pipe(duplex=False)
        self._connection, answers = spawn.Pipe(duplex=False)
        self._others, self._outbox = (ticks, answers), Outbox(outgoing, BACKLOG)
        arguments = network, setup, ticks, answers
        self._process = spawn.Process(target=serve, args=arguments, daemon=True)
        self._poll = select.poll()
        self._poll.register(self._connection, select.POLLIN)

    def __enter__(self) -> Self:
        self._process.start()
        for other in self._others:
            other.close()
        state, reason = "failed", "the publishing process does not start"
        with suppress(EOFError):
            if self._connection.poll(STARTUP):
                state, reason = self._connection.recv()
        if state != "ready":
            self._process.kill()
            self._process.join()
            raise UsageError(
                f"--ros: {reason}; expected a free endpoint, see --ros-listen and --ros-connect"
            )
        return self

    def __exit__(self, *_: object) -> None:
        """End the process and report."""
        with suppress(BrokenPipeError):
            self._outbox.close(LEAVING)
        self._process.join(LEAVING)
        self._process.kill()
        self._process.join()
        self._receive(None)
        published = "an unknown number of" if self._published is None else self._published
        text = f"ros: {published} messages published, {self._dropped} ticks dropped"
        print(text, file=sys.stderr)

    def exchange(self, tick: Tick) -> None:
        """Publish a tick and take the commands that arrived; it never waits."""
        self._send(tick)
        self._receive(tick.time)
        if self._driven_at is not None and tick.time - self._driven_at > TIMEOUT:
            self._driven_at = None
            self._warn("silence", f"/cmd_vel: no message for {TIMEOUT:g} s: the robot stops")

    def _send(self, tick: Tick) -> None:
        if self._gone:
            self._dropped += 1
            return
        try:
            if not self._outbox.put([*self._rows(tick)]):
                self._dropped += 1
                self._warn("slow", "the publishing process is too slow: ticks are dropped")
        except BrokenPipeError:
            self._gone = True
            self._warn("gone", "the publishing process ended: the run goes on without topics")

    def _rows(self, tick: Tick) -> Iterator[Row]:
        if tick.number == 0 and tick.record is not None:
            yield START, {"time": 0.0, "start": tick.record.truth.robot}
        yield self._row("ticks", tick)
        record: TickRecord | None = tick.record
        if record is None:
            return
        if (frame := record.frame) is not None:
            yield self._row("frames", self._sampler.sample(frame))
            if frame.image is not None:
                times = {"time": frame.time, "captured": frame.measured.time}
                yield PIXELS, {**times, "image": frame.image}
        yield self._row("records", record)

    def _row(self, table: str, recorded: object) -> Row:
        return table, {name: get(recorded) for name, get in self._getters[table]}

    def _receive(self, time: float | None) -> None:
        """Take the messages of the process after the tick at a time [s]; None after the last."""
        while self._poll.poll(0):
            try:
                kind, content = self._connection.recv()
            except (EOFError, OSError):
                self._poll.unregister(self._connection)
                return
            if kind == "published":
                self._published = content
            elif kind == "refused":
                self._warn(*content)
            elif time is not None and self._drive is not None:
                self._command(self._drive, time, content[1])

    def _command(self, drive: Drive, time: float, command: Command) -> None:
        if not isinstance(command, dict):
            self._driven_at = time
            drive.add(DriveCommand(time, velocity=command))
            return
        head = [self._model.names[joint] for joint in self._model.tree.head or ()]
        if not command.keys() & set(head):
            expected = " or ".join(head) or "a robot with a movable head"
            got = ", ".join(command) or "no joint of the robot"
            self._warn("/head/command", f"/head/command: got {got}; expected {expected}")
            return
        for name in command.keys() & set(head):
            self._posture[self._model.names.index(name)] = command[name]
        drive.add(DriveCommand(time, gaze=self._model.neck.angles(self._posture)))

    def _warn(self, kind: str, text: str) -> None:
        """Warn once of each kind."""
        if kind not in self._warned:
            self._warned.add(kind)
            print(f"ros: {text}", file=sys.stderr, flush=True)


def require_zenoh() -> None:
    """Require the packages of the extra `ros`.

    Raises:
        UsageError: one is not installed.
    """
    require_rosbags()
    if find_spec("zenoh") is None:
        raise UsageError("--ros: no module zenoh; pip install -e '.[ros]' in the checkout")


def _getters(table: str) -> list[tuple[str, Callable[[Any], Any]]]:
    """Return names and getters of the columns of a table that topics need."""
    needed = {column for topic in TOPICS if topic.table == table for column in topic.columns}
    columns = [column for column in TABLES[table].columns if column.name in {"time", *needed}]
    return [(c.name, partial(_objects, c) if c.items else c.get) for c in columns]


def _objects(column: Column, recorded: object) -> Mapping[str, Any]:
    """Return the objects in a column by column."""
    assert column.arrays is not None
    return column.arrays([column.get(recorded)])
