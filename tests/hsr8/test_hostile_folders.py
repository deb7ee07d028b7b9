"""Damaged and hostile folders of runs and sweeps: read or refused with one line, never followed.

Whatever a folder holds, a command ends within 20 s and 2 GB, without a traceback, and writes
nothing outside of the folder. The slow test takes 1000 folders.
"""

import faulthandler
import os
import re
import resource
import shutil
import socket
import time

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hsr8.cli.main import entry

LIMIT = 20  # processor time of a command [s]
HANG = 100  # wall time after which the process ends, with a trace in hang.txt [s]
MEMORY = 2_000_000  # resident memory of the process [kB]
LIGHT = ("--body", "kinematic", "--camera", "analytic", "--quiet")
COMMANDS = [
    "info RUN",
    "info RUN --json",
    "diff RUN WHOLE",
    "diff WHOLE RUN --json",
    "compare RUN WHOLE",
    "export RUN --csv NEW",
    "bench compare RUN WHOLE",
    "compare SWEEP SWEEP",
    "replay RUN",
    "plot RUN --what tilt",
]
SLOW_COMMANDS = [
    "verify RUN",
    "render RUN --size 64x64 --fps 1 --speed 1 --quiet --camera top",
    "export RUN --bag NEW --lerobot NEW2",
    "sweep quick --seeds 0:2 --duration 0.1 --quiet --keep none --out SWEEP",
]
OUTPUTS = ["log.rrd", "tilt.png", "video.mp4", "video.png", "bag", "crash.txt"]
TABLES = ["ticks", "records", "frames", "seconds", "events", "images"]
FILES = ["manifest.json", "metrics.json", "scenario.toml", "checksums.txt"]
OF_RUN = FILES + [f"{name}.arrows" for name in TABLES] + OUTPUTS
OF_SWEEP = ["sweep.json", "scenario.toml", "runs.jsonl", "report.md", "runs.parquet", "runs"]
OF_SWEEP += ["shard-1-of-2.jsonl", "bench.json", "runs/quick"]
SLOW = (pytest.mark.slow, pytest.mark.timeout(7200))
KINDS = [
    *("link", "dangling", "zero", "null", "full", "fifo", "socket", "folder", "sparse", "empty"),
    *("cut", "flip", "insert", "swap", "gone", "loop", "value"),
]
VALUE = re.compile(rb'(?<=[:,\[])\s*(-?[\d.e+-]+|"[^"]*"|true|false|null|\[\]|\{\})')  # of JSON
VALUES = [b"null", b"-1", b"1e400", b"1e308", b'"x"', b"[]", b"{}", b"true", b"NaN", b"[" * 3000]
VALUES += [b"1" * 5000]
damages = st.lists(
    st.tuples(
        st.sampled_from(KINDS),
        st.integers(0, 10**6),
        st.floats(0.0, 1.0),
        st.binary(min_size=1, max_size=16),
    ),
    min_size=1,
    max_size=3,
)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A run as a kill leaves it, and a sweep of two runs."""
    out = tmp_path_factory.mktemp("whole")
    assert entry(["run", "quick", *LIGHT, "--duration", "1.2", "--out", str(out)]) == 1
    (run,) = (out / "quick").iterdir()
    manifest = run / "manifest.json"
    manifest.write_text(manifest.read_text().replace('"timeout"', '"running"'))
    words = ["sweep", "quick", "--seeds", "0:2", "--duration", "0.1", *LIGHT, "--out"]
    entry([*words, str(out / "sweep")])
    return {"RUN": run, "SWEEP": out / "sweep"}


@pytest.fixture
def outside(tmp_path):
    """Folder that no command may write to."""
    folder = tmp_path / "outside"
    folder.mkdir()
    (folder / "kept.txt").write_text("as it was")
    return folder


def head(path):
    """Return the content of a file, of a sparse one its beginning."""
    if not path.is_file():
        return b""
    with path.open("rb") as file:
        return file.read(10_000_000)


def damage(folder, names, outside, kind, choice, place, content):
    """Damage one file of a folder."""
    path = folder / names[choice % len(names)]
    if path.parent != folder and (path.parent.is_symlink() or not path.parent.is_dir()):
        return  # an earlier damage took the folder of the file
    old = head(path)
    other = folder / names[(choice // len(names)) % len(names)]
    swapped = head(other)
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    path.unlink(missing_ok=True)
    at = int(place * len(old))
    links = {"zero": "/dev/zero", "null": "/dev/null", "full": "/dev/full", "loop": path.name}
    links |= {"link": outside / "kept.txt", "dangling": outside / "new"}
    if kind in links:
        path.symlink_to(outside if path.name in ("runs", "quick") else links[kind])
    elif kind == "fifo":
        os.mkfifo(path)
    elif kind == "socket":
        with socket.socket(socket.AF_UNIX) as server:
            os.chdir(path.parent)  # the name of a socket is short
            server.bind(path.name)
    elif kind == "folder":
        path.mkdir()
    elif kind == "sparse":
        path.write_bytes(old)
        os.truncate(path, 60_000_000_000)
    elif kind == "value":
        values = list(VALUE.finditer(old)) or [re.match(b"", b"")]
        start, end = values[int(place * (len(values) - 1))].span()
        path.write_bytes(old[:start] + VALUES[choice % len(VALUES)] + old[end:])
    elif kind != "gone":
        after = {"cut": b"", "insert": content + old[at:], "empty": b""}
        flipped = bytes(a ^ b for a, b in zip(old[at:], content, strict=False))
        after["flip"] = flipped + old[at + len(flipped) :]
        new = {"empty": b"", "swap": swapped}
        path.write_bytes(new[kind] if kind in new else old[:at] + after[kind])


def check(whole, outside, case, capfd, command, list_of_damages):
    """Damage a copy of a run or sweep and run a command on it."""
    shutil.rmtree(case, ignore_errors=True)
    case.mkdir()
    target = "SWEEP" if "SWEEP" in command else "RUN"
    folder = case / "folder"
    shutil.copytree(whole[target], folder)
    for one in list_of_damages:
        damage(folder, OF_SWEEP if target == "SWEEP" else OF_RUN, outside, *one)
    os.chdir(case)
    places = {target: folder, "WHOLE": whole["RUN"], "NEW": case / "new", "NEW2": case / "new2"}
    words = [str(places.get(word, word)) for word in command.split()]
    capfd.readouterr()
    began = time.process_time()
    with (case.parent / "hang.txt").open("w") as hang:
        print(words, list_of_damages, file=hang, flush=True)
        faulthandler.dump_traceback_later(HANG, exit=True, file=hang)
        code = entry(words)
        faulthandler.cancel_dump_traceback_later()
    assert time.process_time() - began < LIMIT
    error = capfd.readouterr().err
    assert code in (0, 1, 2, 3), (code, error)
    assert "Traceback" not in error
    assert "internal error" not in error
    assert code < 2 or error.strip()
    assert [path.name for path in outside.iterdir()] == ["kept.txt"]
    assert (outside / "kept.txt").read_text() == "as it was"
    assert not [path for path in folder.rglob("*.part") if path.is_dir()]
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < MEMORY


@pytest.mark.parametrize(
    ("commands", "count"),
    [(COMMANDS, 60), pytest.param(COMMANDS + SLOW_COMMANDS, 1000, marks=SLOW)],
)
def test_any_folder_is_read_or_refused(
    whole, outside, tmp_path, monkeypatch, capfd, commands, count
):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.chdir(tmp_path)

    @settings(max_examples=count, suppress_health_check=list(HealthCheck))
    @given(command=st.sampled_from(commands), list_of_damages=damages)
    def holds(command, list_of_damages):
        check(whole, outside, tmp_path / "case", capfd, command, list_of_damages)

    holds()
