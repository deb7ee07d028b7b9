"""How a sweep gets on, on standard error, with the time that is left."""

import sys
import time as clock

from rich.console import Console
from rich.live import Live
from rich.text import Text

from hsr8.evaluation.sweep.job import CRASHED, Row
from hsr8.evaluation.sweep.report import fault


class SweepProgress:
    """One live line on a terminal; elsewhere a line for every run that ends.

    Args:
        total: runs of the whole sweep.
        done: of them, those that were there before.
    """

    def __init__(self, total: int, done: int) -> None:
        self._total, self._before, self._done = total, done, done
        self._succeeded = self._failed = self._crashed = 0
        self._began = clock.monotonic()
        console = Console(stderr=True)
        self._live: Live | None = None
        if console.is_terminal:
            self._live = Live(console=console, auto_refresh=False, transient=True)
            self._live.start()

    def on_row(self, row: Row) -> None:
        """Count a run that ended."""
        self._done += 1
        self._succeeded += bool(row.get("success"))
        self._crashed += row["outcome"] == CRASHED
        self._failed += not row.get("success") and row["outcome"] != CRASHED
        what = fault(row)
        text = f"seed {row['seed']}: {what or 'good'}"
        if self._live is None:
            print(f"{self.line()}   {text}", file=sys.stderr, flush=True)
        elif what:
            self._live.console.print(Text(text, style="yellow"))

    def tick(self) -> None:
        """Bring the live line up to date."""
        if self._live is not None:
            self._live.update(Text(self.line(), style="cyan"), refresh=True)

    def close(self) -> None:
        """Remove the live line."""
        if self._live is not None:
            self._live.stop()
            self._live = None

    def line(self) -> str:
        """How far it is."""
        crashed = f", {self._crashed} crashed" if self._crashed else ""
        return (
            f"{self._done}/{self._total} runs   {self._succeeded} succeeded, {self._failed} not"
            f"{crashed}   {self._left()}"
        )

    def _left(self) -> str:
        ended = self._done - self._before
        if ended == 0:
            return "time left unknown"
        seconds = (clock.monotonic() - self._began) / ended * (self._total - self._done)
        return f"about {spell(seconds)} left"


def spell(seconds: float) -> str:
    """A time as people say it."""
    minutes = round(seconds / 60)
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60:02d} min"
