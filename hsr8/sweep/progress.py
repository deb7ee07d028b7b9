"""Progress of a sweep on standard error, with the remaining time."""

import sys
import time as clock
from datetime import timedelta

from rich.console import Console
from rich.live import Live
from rich.text import Text

from hsr8.sweep.job import CRASHED, REFUSED, RunResult
from hsr8.sweep.report import problem


class SweepProgress:
    """One live line on a terminal; elsewhere one line per run that ends.

    Args:
        total: number of runs of the whole sweep.
        done: number of runs that have results already.
    """

    def __init__(self, total: int, done: int) -> None:
        self._total, self._left = total, total - done
        self._ended = self._succeeded = self._crashed = self._refused = 0
        self._started = clock.monotonic()
        console = Console(stderr=True)
        self._live: Live | None = None
        if console.is_terminal:
            self._live = Live(console=console, auto_refresh=False, transient=True)
            self._live.start()

    def on_result(self, result: RunResult, sweep: str = "") -> None:
        """Count a run that ended.

        Args:
            result: result of the run.
            sweep: name of its sweep, if there are several.
        """
        self._ended += 1
        self._left -= 1
        self._succeeded += bool(result.get("success"))
        self._crashed += result["outcome"] == CRASHED
        self._refused += result["outcome"] == REFUSED
        run = f"{sweep} seed {result['seed']}".lstrip()
        text = f"{run}: {problem(result) or 'success'}"
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
        failed = self._ended - self._succeeded - self._crashed - self._refused
        counts = f"{self._succeeded} succeeded, {failed} failed, {self._crashed} crashed"
        counts += f", {self._refused} refused" if self._refused else ""
        time = "remaining time unknown"
        if self._ended:
            seconds = (clock.monotonic() - self._started) / self._ended * self._left
            time = f"about {timedelta(seconds=round(seconds))} left"
        return f"{self._total - self._left}/{self._total} runs   {counts}   {time}"
