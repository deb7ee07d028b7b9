"""Kill runs at random times; what is left of each must be readable, and almost all of it.

python scripts/kill_study.py --kills 50 --out docs/results/kill.md
"""

import argparse
import mmap
import os
import random
import signal
import struct
import sys
import tempfile
import time as clock
import warnings
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

from hsr8.evaluation.recording import Recording, renderer_of
from hsr8.evaluation.sweep.definition import Definition
from hsr8.loop import Simulation
from hsr8.recorder.record import Listener, TickRecord
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.manifest import Manifest
from hsr8.recorder.run.run_folder import RunFolder
from hsr8.recorder.run.run_reader import open_run
from hsr8.recorder.run.tape import read_tape
from hsr8.scenario.loader import dump, load_scenario
from walking.parameters import CONTROL_PERIOD

from study_page import STAND_INS, command_line

CLOCK = struct.Struct("<d")


class Watch(Listener):
    """Listener that leaves the simulated time where a kill does not reach it."""

    def __init__(self, path: Path) -> None:
        with path.open("r+b") as file:
            self._memory = mmap.mmap(file.fileno(), CLOCK.size)

    def on_record(self, record: TickRecord) -> None:
        """Note its time."""
        self._memory[:] = CLOCK.pack(record.time)


@dataclass(frozen=True, slots=True)
class Left:
    """What a killed run left.

    Attributes:
        killed: simulated time at the kill [s].
        ends: last simulated time in every record [s]; of a run killed before its first second
            a record may be empty or missing.
        readable: whether every record could be read.
    """

    killed: float
    ends: dict[str, float]
    readable: bool

    @property
    def lost(self) -> float:
        """The most that any record lacks [s]."""
        return max((self.killed - end for end in self.ends.values()), default=self.killed)


def run(out: str, watch: str, settings: tuple[str, ...], seed: int) -> None:
    """Run with a log, in its own process."""
    scenario = load_scenario("quick", settings, seed=seed)
    simulation = Simulation(scenario, seed)
    recording = Recording(simulation, [Watch(Path(watch))])
    path = RunFolder.create(Path(out), scenario.name, seed)
    manifest = Manifest.now(scenario.name, seed, ("hsr8",), renderer_of(scenario))
    recording.into(path, manifest)
    recording.run()


def killed(out: Path, settings: tuple[str, ...], seed: int, after: float) -> Left:
    """Kill a run `after` a simulated time [s] and examine its folder."""
    watch = out / "clock"
    watch.write_bytes(CLOCK.pack(-1.0))
    processes = get_context("forkserver")
    processes.set_forkserver_preload(["hsr8.evaluation.recording"])
    process = processes.Process(target=run, args=(str(out), str(watch), settings, seed))
    process.start()
    while CLOCK.unpack(watch.read_bytes())[0] < after and process.is_alive():
        clock.sleep(random.Random(seed).uniform(0.0005, 0.002))
    assert process.pid is not None
    os.kill(process.pid, signal.SIGKILL)
    process.join()
    (time,) = CLOCK.unpack(watch.read_bytes())
    return examined(out, max(time, 0.0), seed)


def examined(out: Path, time: float, seed: int) -> Left:
    """Read every record."""
    ends: dict[str, float] = {}
    readable = True
    found = open_run(out)
    for name, end in (
        ("log", lambda: log_end(found.path / run_folder.LOG)),
        ("motion", lambda: float(found.trajectory().time[-1])),
        ("walking", lambda: float(found.walking().time[-1])),
        ("tape", lambda: tape_end(found.path)),
    ):
        try:
            ends[name] = end()
        except IndexError:  # nothing of it yet
            ends[name] = 0.0
        except Exception as error:  # told in the table
            readable = readable and time < 1.0
            print(f"seed {seed}: {name} at {time:.2f} s: {error}", file=sys.stderr)
            ends[name] = 0.0
    found.frames(), found.events()
    return Left(time, ends, readable)


def log_end(file: Path) -> float:
    """Last simulated time in a Rerun log [s]."""
    from rerun.chunk import RrdReader  # noqa: PLC0415 (the runs want it fresh)

    last = 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a kill leaves no footer
        for chunk in RrdReader(str(file)).stream():
            batch = chunk.to_record_batch()
            if "sim_time" in batch.schema.names and batch.num_rows:
                times = batch.column("sim_time").cast("int64").to_pylist()
                last = max(last, max(times) / 1e9)
    return last


def tape_end(folder: Path) -> float:
    """End of the last whole second of the tape [s]."""
    block = read_tape(folder / run_folder.TAPE, whole=False)[-1]
    return (block.tick + len(block.setpoints)) * CONTROL_PERIOD


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--full", type=int, default=5, help="how many of them with full physics")
    parser.add_argument("--duration", type=float, default=8.0, help="of a run [s]")
    parser.add_argument("--seed", type=int, default=1000, help="of the first run")
    parser.add_argument("--out", type=Path, required=True, help="Markdown file to write")
    arguments = parser.parse_args()
    draw, rows = random.Random(arguments.seed), []
    made_with = Definition.now("quick", (), dump(load_scenario("quick"))).made_with()
    for k in range(arguments.kills):
        seed, full = arguments.seed + k, k < arguments.full
        length = f"duration={arguments.duration}"
        settings = (length,) if full else (length, *STAND_INS)
        after = draw.uniform(0.0, arguments.duration - 0.5)
        with tempfile.TemporaryDirectory() as folder:
            left = killed(Path(folder), settings, seed, after)
        ends = " | ".join(f"{left.killed - end:.2f}" for end in left.ends.values())
        body = "full, rendered" if full else "kinematic, analytic"
        readable = "yes" if left.readable else "NO"
        rows.append((left, f"| {seed} | {body} | {left.killed:.2f} | {readable} | {ends} |"))
        print(rows[-1][1], flush=True)
        write(arguments, made_with, rows)


def write(arguments: argparse.Namespace, made_with: str, rows: list[tuple[Left, str]]) -> None:
    """The page, also of a study that is not over."""
    lefts = [left for left, _ in rows]
    lines = [
        "# Runs killed at random times",
        "",
        f"    {command_line()}",
        "",
        f"{made_with}.",
        "",
        "`quick` with log, killed by SIGKILL at a random simulated time. The loss of a file is the "
        "time from its last row to the last record before the kill.",
        "",
        f"{sum(left.readable for left in lefts)} of {len(lefts)} folders readable; at most "
        f"{max(left.lost for left in lefts):.2f} s lost.",
        "",
        "| seed | body, camera | killed at [s] | readable | lost of log [s] | of motion [s] "
        "| of walking [s] | of tape [s] |",
        "|---|---|---|---|---|---|---|---|",
        *(row for _, row in rows),
    ]
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
