"""Does anything grow: memory, open files, threads, OpenGL contexts, time per tick.

    python scripts/soak_study.py --light 600 --full 180 --runs 60 --write

One long run with the stand-in body and camera and one with full physics and rendered camera, both
with all records and the log on an endless tour; then many short runs in the same process, every
tenth of them with full physics and camera. What grows after the warm-up is growth.
"""

import argparse
import gc
import os
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from time import thread_time

from hsr8.evaluation.recording import Recording, renderer_of
from hsr8.loop import TICKS_A_SECOND, Simulation
from hsr8.recorder.run.manifest import Manifest
from hsr8.recorder.run.run_folder import RunFolder
from hsr8.scenario.loader import load_scenario

import mujoco
import numpy as np
from study_page import RESULTS, STAND_INS, add_seeds, command_line, environment

MB = 1024.0 * 1024.0
PAGE_SIZE = os.sysconf("SC_PAGE_SIZE")
WINDOWS = 10  # parts of a run that are told apart
HOUR = 3600.0  # of which the long runs are the beginning [s]
WARM = 0.2  # share of a run that is its warm-up


@dataclass
class Sample:
    """What the process holds now, and the processor time per tick since the sample before."""

    at: float
    memory: float
    files: int
    threads: int
    contexts: int
    tick_ms: float


def held(at: float, tick_ms: float) -> Sample:
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    contexts = sum(isinstance(o, mujoco.GLContext) and _alive(o) for o in gc.get_objects())
    return Sample(
        at,
        pages * PAGE_SIZE / MB,
        len(os.listdir("/proc/self/fd")),
        len(os.listdir("/proc/self/task")),
        contexts,
        tick_ms,
    )


def _alive(context: object) -> bool:
    return bool(getattr(context, "_context", None))


class Watch:
    """Samples a simulation now and then, from inside it."""

    def __init__(self, simulation: Simulation, duration: float) -> None:
        self.samples: list[Sample] = []
        self._simulation, self._last = simulation, round(duration * TICKS_A_SECOND)
        self._period = self._last // WINDOWS
        self._times: list[float] = []
        self._step, simulation.step = simulation.step, self.step

    def step(self) -> object:
        """Take the place of the simulation's own step."""
        simulation = self._simulation
        if simulation.tick and simulation.tick % self._period == 0:
            times = 1e3 * np.array(self._times)
            self.samples.append(held(simulation.time, float(times.mean())))
            self._times.clear()
        if simulation.tick >= self._last:
            simulation.interrupt()
        began = thread_time()
        record = self._step()
        self._times.append(thread_time() - began)
        return record


def simulation_of(name: str, seed: int, duration: float, settings: tuple[str, ...]) -> Simulation:
    return Simulation(load_scenario(name, [*settings, f"duration={duration}"], seed=seed), seed)


def recorded(simulation: Simulation, folder: str) -> str:
    scenario = simulation.scenario
    recording = Recording(simulation)
    path = RunFolder.create(Path(folder), scenario.name, scenario.seed)
    manifest = Manifest.now(scenario.name, scenario.seed, ("soak_study",), renderer_of(scenario))
    recording.into(path, manifest)
    return recording.run().exit_reason


def long_run(seed: int, duration: float, settings: tuple[str, ...]) -> tuple[list[Sample], str]:
    simulation = simulation_of("paper", seed, HOUR, settings)
    watch = Watch(simulation, duration)
    with tempfile.TemporaryDirectory() as folder:
        reason = recorded(simulation, folder)
    return watch.samples, f"{reason} at {simulation.time:.0f} s"


def many_runs(seeds: Iterator[int], count: int) -> list[Sample]:
    samples = []
    for k in range(count):
        full = k % 10 == 0
        duration = 1.0
        simulation = simulation_of("course", next(seeds), duration, () if full else STAND_INS)
        began = thread_time()
        with tempfile.TemporaryDirectory() as folder:
            recorded(simulation, folder)
        spent = 1e3 * (thread_time() - began) / simulation.tick
        del simulation
        if not full and k % max(1, count // 12) == 1 % max(1, count // 12):
            samples.append(held(k + 1, spent))
            print(f"{k + 1} runs: {samples[-1].memory:.1f} MB", flush=True)
    return samples


def row(name: str, samples: list[Sample]) -> str:
    first = samples[max(1, round(WARM * len(samples))) :]
    a, b = first[0], first[-1]
    half = len(first) // 2
    early, late = (np.median([s.tick_ms for s in part]) for part in (first[:half], first[-half:]))
    slope = np.polyfit([s.at for s in first], [s.memory for s in first], 1)[0]
    return (
        f"| {name} | {a.memory:.1f} | {b.memory:.1f} | {b.memory - a.memory:+.1f} | "
        f"{slope * (b.at - a.at):+.1f} | {a.files} → {b.files} | {a.threads} → {b.threads} | "
        f"{a.contexts} → {b.contexts} | {early:.2f} → {late:.2f} ({late / early - 1:+.1%}) |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--light", type=float, default=600.0, help="long run, stand-ins [s]")
    parser.add_argument("--full", type=float, default=180.0, help="long run, full physics [s]")
    parser.add_argument("--runs", type=int, default=60, help="short runs in one process")
    add_seeds(parser, [1000])
    parser.add_argument("--write", action="store_true", help="write soak.md")
    options = parser.parse_args()
    seed = options.seeds[0]
    table = [
        "| what | MB after warm-up | MB at the end | grown [MB] | by a fitted line [MB] | "
        "open files | threads | OpenGL contexts | CPU time per tick [ms], halves |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    parts = (("light", options.light, STAND_INS), ("full", options.full, ()))
    for name, duration, settings in parts:
        if duration:
            samples, end = long_run(seed, duration, settings)
            for sample in samples:
                print(sample, flush=True)
            bodies = "stand-ins" if name == "light" else "full physics, rendered camera"
            table.append(row(f"one run of {duration:.0f} s, {bodies} ({end})", samples))
            print(table[-1], flush=True)
    if options.runs:
        samples = many_runs(iter(range(seed, seed + options.runs)), options.runs)
        for sample in samples:
            print(sample, flush=True)
        table.append(row(f"{options.runs} short runs in one process", samples))
        print(table[-1], flush=True)
    if options.write:
        lines = [
            "# What grows in long runs and in many runs",
            "",
            f"{environment(('hsr8', 'mujoco', 'numpy', 'rerun-sdk'))}.",
            "",
            "Scenario `paper` (an endless tour) for the long runs, the beginning of an hour "
            "each, and `course` for the short "
            "ones, with every record and the log. Of each row the first "
            f"{WARM:.0%} are the warm-up. Of the short runs, one in ten has full physics "
            "and rendered camera. Memory is resident memory after a collection.",
            "",
            f"    {command_line()}",
            "",
            *table,
            "",
        ]
        (RESULTS / "soak.md").write_text("\n".join(lines))


if __name__ == "__main__":
    main()
