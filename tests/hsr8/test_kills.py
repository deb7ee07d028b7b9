"""A killed run leaves a readable folder that lacks at most one simulated second."""

import mmap
import random
import struct
import subprocess
import sys
import time

import pytest

from hsr8.recording.run import open_run
from walking.parameters import CONTROL_PERIOD

COUNT = struct.Struct("<q")
LIGHT = ("--body", "kinematic", "--camera", "analytic")
MAX_LOSS = 1.0  # time that a killed run may lack [s]
WAIT = 300.0  # wall time until the first tick, with compilation [s]
PROGRAM = """
import mmap, struct, sys
from hsr8.cli.main import entry
from hsr8.recording.recorder import Recorder

with open(sys.argv[1], "r+b") as file:
    ticks = mmap.mmap(file.fileno(), 8)
append = Recorder.append
def counted(recorder, tick):
    append(recorder, tick)
    ticks[:] = struct.pack("<q", tick.number + 1)
Recorder.append = counted
entry(sys.argv[2:])
"""
"""Command line that keeps the number of recorded ticks in a file, which outlives the kill."""


def killed(folder, seed, options, delay):
    """Return a run killed `delay` [s] of wall time after its first tick, and when [s]."""
    counter = folder / "ticks"
    counter.write_bytes(bytes(COUNT.size))
    words = ["run", "course", "--seed", str(seed), "--quiet", "--out", str(folder), *options]
    with counter.open("r+b") as file, mmap.mmap(file.fileno(), COUNT.size) as ticks:
        process = subprocess.Popen([sys.executable, "-c", PROGRAM, str(counter), *words])
        began = time.monotonic()
        while not any(ticks[:]) and process.poll() is None and time.monotonic() - began < WAIT:
            time.sleep(0.01)
        time.sleep(delay)
        ended = process.poll()
        process.kill()
        process.wait()
        (count,) = COUNT.unpack(ticks[:])
    assert ended is None, "the run ended before the kill"
    assert count
    return open_run(folder), count * CONTROL_PERIOD


@pytest.mark.parametrize(
    "kills", [1, pytest.param(50, marks=[pytest.mark.slow, pytest.mark.timeout(3600)])]
)
def test_a_killed_run_is_readable_up_to_its_last_second(kills, tmp_path):
    rng = random.Random(kills)
    for k in range(kills):
        folder = tmp_path / str(k)
        folder.mkdir()
        run, end = killed(folder, 1000 + k, () if k % 10 == 9 else LIGHT, rng.uniform(0.2, 2.0))
        for table in (run.ticks, run.records, run.frames):
            times = table["time"].tolist()
            last = times[-1] + times[-1] - times[-2] if len(times) > 1 else 0.0
            assert end - last < MAX_LOSS + CONTROL_PERIOD, (k, end)
        assert run.manifest["exit_reason"] == "running"
