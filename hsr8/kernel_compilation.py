"""Compilation of the Numba kernels ahead of a run, in two processes.

Numba compiles a kernel at its first call and keeps it on disk. The kernels of a run take most of a
minute the first time. `kernels.txt` lists them with the types of their arguments, so they can be
compiled without a run; `scripts/write_kernel_list.py` writes it. Kernels of different files are
independent: a file is compiled by one process.
"""

import importlib
import os
import signal
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter
from typing import Self

from numba import types
from numba.core import event

from hsr8.parent_watch import end_with_parent

LIST = Path(__file__).with_name("kernels.txt")
PACKAGES = ("compilation", "hsr8", "navigation", "vision", "walking")
PROCESSES = 2
COMPILE = "numba:compile"  # event of a kernel that is not on disk

Progress = Callable[[int, int], None]


def listed() -> dict[str, list[tuple[str, str]]]:
    """Return names and argument types of the kernels of a run, by module."""
    kernels: dict[str, list[tuple[str, str]]] = {}
    for line in LIST.read_text(encoding="utf-8").splitlines():
        name, signature = line.split(" ", 1)
        module, _, function = name.rpartition(".")
        kernels.setdefault(module, []).append((function, signature))
    return kernels


def compile_kernels(show: Progress) -> int:
    """Compile the listed kernels that are not on disk; return their number.

    Args:
        show: called with the number of finished kernels and of all, at the start and after
            every file.
    """
    kernels = listed()
    total, done, compiled = sum(map(len, kernels.values())), 0, 0
    show(done, total)
    largest_first = sorted(kernels, key=lambda module: -_size(module))
    with ProcessPoolExecutor(PROCESSES, get_context("spawn"), _worker) as pool:
        tasks = {pool.submit(compile_module, m, kernels[m]): m for m in largest_first}
        for task in as_completed(tasks):
            compiled += task.result()
            done += len(kernels[tasks[task]])
            show(done, total)
    return compiled


def compile_module(module: str, kernels: list[tuple[str, str]]) -> int:
    """Compile kernels of one module, or load them from disk; return the number of compiled ones."""
    names = vars(types) | {"bool": vars(types)["boolean"]}
    compiled = 0
    for function, signature in kernels:
        kernel = getattr(importlib.import_module(module), function)
        kernel.compile(eval(signature, names))
        compiled += bool(kernel.stats.cache_misses)
    return compiled


class CompilationWatch(event.Listener):
    """Watch of the kernels that this process compiles, used by ``with``.

    Args:
        on_listed: called once, before the first compilation of a listed kernel.

    Attributes:
        seconds: wall time of compilations so far, with that of `on_listed` [s].
        count: number of compiled kernels of hsr8, without those that they call.
    """

    def __init__(self, on_listed: Callable[[], object] | None = None) -> None:
        self._on_listed = on_listed
        self._depth = 0
        self._started = 0.0
        self.seconds = 0.0
        self.count = 0

    def __enter__(self) -> Self:
        event.register(COMPILE, self)
        return self

    def __exit__(self, *_: object) -> None:
        event.unregister(COMPILE, self)

    def on_start(self, event: event.Event) -> None:
        """Begin a compilation, which may be part of another one."""
        self._depth += 1
        if self._depth > 1:
            return
        self._started = perf_counter()
        function = event.data["dispatcher"].py_func
        if function.__module__.partition(".")[0] not in PACKAGES:
            return
        self.count += 1
        call = self._on_listed
        if call and function.__name__ in dict(listed().get(function.__module__, [])):
            self._on_listed = None
            call()

    def on_end(self, event: event.Event) -> None:
        """End a compilation."""
        self._depth -= 1
        if self._depth == 0:
            self.seconds += perf_counter() - self._started


def _size(module: str) -> int:
    return Path(__file__).parents[1].joinpath(*module.split(".")).with_suffix(".py").stat().st_size


def _worker() -> None:
    """End with the parent, and at Ctrl-C without a traceback."""
    end_with_parent(os.getppid())
    signal.signal(signal.SIGINT, signal.SIG_DFL)
