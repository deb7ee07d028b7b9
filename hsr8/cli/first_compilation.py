"""Compilation of the first run, in two processes.

Numba compiles a function at its first call, half a minute in all. The walking engine comes first:
while a run compiles it, a second process lets a standing robot see and decide, and thereby
compiles vision and navigation.
"""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from compilation.function import CompiledFunction
from hsr8.errors import RenderingUnavailable
from hsr8.plugins.walker import RobotInfo
from hsr8.process.compilation_watch import CompilationWatch
from hsr8.process.gl import require_gl
from hsr8.process.signals import with_parent_watch
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation
from navigation.angles import wrap
from walking.command import VelocityCommand
from walking.observer import BodyEstimate
from walking.state import BodySensors

TEXT = "compiling the inner loops, once per installation: up to half a minute"
NOT_KEPT = (
    "compiling the inner loops, a minute in every run because no folder can be written; "
    "NUMBA_CACHE_DIR=DIR keeps them"
)
CODE = "from hsr8.cli.first_compilation import see_and_decide; see_and_decide({source!r})"
SCENARIOS = ("course", "paper")  # that call everything; beacons are obstacles in the second
SECONDS = 3.0  # simulated time in which obstacles hide each other and are looked at [s]


@contextmanager
def two_processes(source: str, *, quiet: bool) -> Iterator[CompilationWatch]:
    """Compile vision and navigation in a second process if this one compiles the walking engine.

    Args:
        source: source of the camera, as in a scenario.
        quiet: print nothing.
    """
    processes: list[subprocess.Popen[bytes]] = []
    kept, announced = can_keep(), quiet

    def before(package: str) -> None:
        nonlocal announced
        if not announced:
            print(TEXT if kept else NOT_KEPT, file=sys.stderr, flush=True)
            announced = True
        if package == "walking" and kept and not processes:
            command = [sys.executable, "-P", "-c", CODE.format(source=source)]
            null = subprocess.DEVNULL
            words = with_parent_watch(command)
            processes.append(subprocess.Popen(words, stdin=null, stdout=null, stderr=null))
        elif package != "walking":
            for process in processes:
                process.wait()

    try:
        with CompilationWatch(before) as watch:
            yield watch
    finally:
        for process in processes:
            process.terminate()
            process.wait()


def can_keep() -> bool:
    """Return whether compiled code can be kept, if functions are compiled at all."""
    return isinstance(wrap, CompiledFunction) and wrap.stats.cache_path is not None


def compile_all(*, quiet: bool) -> int:
    """Compile all that a run calls and that is not on disk; return the number of functions.

    Args:
        quiet: print nothing.
    """
    try:
        require_gl()
        source = "rendered"
    except RenderingUnavailable:
        source = "analytic"
    with two_processes(source, quiet=quiet) as watch:
        settings = (f"camera.source={source}", f"duration={SECONDS}")
        for scenario in SCENARIOS:
            Simulation(load_scenario(scenario, settings), 0).run()
    return watch.count


def see_and_decide(source: str) -> None:
    """Run a robot that stands among obstacles.

    Args:
        source: source of the camera, as in a scenario.
    """
    settings = (f"camera.source={source}", f"duration={SECONDS}")
    Simulation(load_scenario("course", settings), 0, walker=_Standing()).run()


class _Standing:
    """Walker that holds the ready posture and turns the head."""

    def start(self, robot: RobotInfo) -> None:
        self._robot = robot

    def step(
        self,
        sensors: BodySensors,
        command: VelocityCommand,
        head: np.ndarray,
        estimate: BodyEstimate,
    ) -> np.ndarray:
        setpoints = self._robot.ready.copy()
        setpoints[self._robot.head] = head
        return setpoints
