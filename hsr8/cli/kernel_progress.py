"""Announcement and progress of the compilation of the kernels on standard error."""

import sys
from time import perf_counter
from typing import TextIO

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from hsr8.kernel_compilation import compile_kernels

TITLE = "compiling the kernels, once per installation"
LINES = 4  # without a terminal


def compile_announced(*, quiet: bool, stream: TextIO | None = None) -> int:
    """Compile the kernels that are not on disk; return their number.

    A terminal gets a bar, any other stream a few lines.

    Args:
        quiet: print nothing.
        stream: output; standard error by default.
    """
    console = Console(file=stream or sys.stderr, quiet=quiet)
    if console.is_terminal:
        columns = (TextColumn(TITLE), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
        with Progress(*columns, console=console, transient=True) as bar:
            task = bar.add_task(TITLE, total=None)
            return compile_kernels(lambda n, total: bar.update(task, completed=n, total=total))
    lines = _Lines(console)
    return compile_kernels(lines.show)


class _Lines:
    """Progress as plain lines."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._started = perf_counter()
        self._next = 0.0

    def show(self, done: int, total: int) -> None:
        if done >= self._next:
            elapsed = perf_counter() - self._started
            self._console.out(f"{TITLE}: {done} of {total}, {elapsed:.0f} s", highlight=False)
            self._next = min(done + total / LINES, total)
