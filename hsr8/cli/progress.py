"""Progress of a run in a line on standard error, and its pace."""

import sys
import time as clock
from typing import Self, TextIO

from rich.console import Console
from rich.live import Live
from rich.text import Text

from hsr8.simulation.record import Event, Tick, TickRecord

REFRESH = 0.1  # wall time between two updates of the live line [s]
TOLERANCE = 0.1  # delay of the pace that is not caught up with [s]
PLAIN_PERIOD = 10.0  # simulated time between two lines without a terminal [s]


class Progress:
    """Progress of a run.

    A terminal gets one live line, any other stream a plain line every 10 simulated seconds.

    Args:
        duration: maximum simulated time of the run [s].
        stream: output; standard error by default.
    """

    def __init__(self, duration: float, stream: TextIO | None = None) -> None:
        self._stream = stream or sys.stderr
        self._duration = duration
        self._console = Console(file=self._stream)
        self._live: Live | None = None
        if self._console.is_terminal:
            self._live = Live(console=self._console, auto_refresh=False, transient=True)
        self._collisions = self._via_points = 0
        self._started = clock.perf_counter()
        self._shown_at = self._started
        self._next_line = PLAIN_PERIOD
        self._situation = "starting"

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Remove the live line."""
        if self._live is not None:
            self._live.stop()
            self._live = None

    def show(self, tick: Tick) -> None:
        """Count collisions and show the record, if a new line is due."""
        for event in tick.events:
            self._count(event)
        if tick.record is not None:
            self._show(tick.record)

    def _show(self, record: TickRecord) -> None:
        if record.frame is not None:
            self._via_points = record.frame.task.index
            self._situation = "lost" if record.frame.belief.lost else record.frame.motion.situation
        if self._live is None:
            if record.time >= self._next_line - 1e-9:
                self._next_line += PLAIN_PERIOD
                print(self.line(record), file=self._stream, flush=True)
            return
        self._live.start()  # hides the cursor until `__exit__`, so not in the constructor
        now = clock.perf_counter()
        if now - self._shown_at >= REFRESH:
            self._shown_at = now
            self._live.update(Text(self.line(record), style="cyan"), refresh=True)

    def _count(self, event: Event) -> None:
        """Count a collision; on a terminal print each collision and fall."""
        if event.kind in ("collision", "fall"):
            self._collisions += event.kind == "collision"
            if self._live is not None:
                self._live.console.print(f"[yellow]{event.time:7.1f} s  {event.text}[/]")

    def line(self, record: TickRecord) -> str:
        """Return the line for `record`."""
        rate = record.time / max(clock.perf_counter() - self._started, 1e-6)
        return (
            f"{record.time:6.1f} / {self._duration:.1f} s   {rate:4.1f}x real time"
            f"   via points {self._via_points:3d}   collisions {self._collisions}"
            f"   gait {record.walking.phase:<8}   planner {self._situation}"
        )


class Pace:
    """Upper limit of the pace of a run.

    Args:
        factor: simulated seconds per second, positive.
    """

    def __init__(self, factor: float) -> None:
        self._factor = factor
        self._origin: float | None = None  # wall time of simulated time zero [s]

    def wait(self, tick: Tick) -> None:
        """Wait until a tick is due."""
        now, elapsed = clock.perf_counter(), tick.time / self._factor
        if self._origin is None or now - self._origin - elapsed > TOLERANCE:
            self._origin = now - elapsed
        clock.sleep(max(0.0, self._origin + elapsed - now))
