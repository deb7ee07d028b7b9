"""Progress of a sweep on standard error, with the remaining time."""

import sys
import time as clock
from datetime import timedelta

from rich.console import Console
from rich.live import Live
from rich.text import Text

from hsr8.evaluation.sweep.job import CRASHED, RunResult
from hsr8.evaluation.sweep.report import problem


class SweepProgress:
    """One live line on a terminal; elsewhere one line per run that ends.

    Args:
        total: number of runs of the whole sweep.
        done: number of runs that have results already.
    """

    def __init__(self, total: int, done: int) -> None:
        self._total, self._done_before, self._done = total, done, done
        self._succeeded = self._failed = self._crashed = 0
        self._started = clock.monotonic()
        console = Console(stderr=True)
        self._live: Live | None = None
        if console.is_terminal:
            self._live = Live(console=console, auto_refresh=False, transient=True)
            self._live.start()

    def on_result(self, result: RunResult) -> None:
        """Count a run that ended."""
        self._done += 1
        crashed, success = result["outcome"] == CRASHED, bool(result.get("success"))
        self._crashed += crashed
        self._succeeded += success
        self._failed += not (success or crashed)
        text = f"seed {result['seed']}: {problem(result) or 'success'}"
        if self._live is None:
            print(f"{self._line()}   {text}", file=sys.stderr, flush=True)
        elif problem(result):
            self._live.console.print(Text(text, style="yellow"))

    def refresh(self) -> None:
        """Update the live line."""
        if self._live is not None:
            self._live.update(Text(self._line(), style="cyan"), refresh=True)

    def close(self) -> None:
        """Remove the live line."""
        if self._live is not None:
            self._live.stop()

    def _line(self) -> str:
        crashed = f", {self._crashed} crashed" if self._crashed else ""
        counts = f"{self._succeeded} succeeded, {self._failed} failed{crashed}"
        return f"{self._done}/{self._total} runs   {counts}   {self._remaining()}"

    def _remaining(self) -> str:
        ended = self._done - self._done_before
        if ended == 0:
            return "remaining time unknown"
        seconds = (clock.monotonic() - self._started) / ended * (self._total - self._done)
        return f"about {timedelta(seconds=round(seconds))} left"
