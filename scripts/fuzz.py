"""Fuzz test: each random input must work or be refused with a message.

    python scripts/fuzz.py --cases 50000

A short run and a short sweep are made first; their files are then damaged.
"""

import argparse
import contextlib
import io
import random
import shutil
import tempfile
import time as clock
from collections import Counter
from pathlib import Path
from typing import Any
from unittest.mock import patch

from hsr8.cli.main import entry
from hsr8.errors import ScenarioError, SimulationDiverged, UsageError
from hsr8.evaluation.sweep import folder as sweep_folder
from hsr8.loop import Simulation
from hsr8.recorder.rows import TABLES
from hsr8.recorder.run import run_folder
from hsr8.recorder.stream import CHECKSUMS, SUFFIX
from hsr8.robots import models
from hsr8.scenario.loader import BUILT_IN, built_in_names, load_scenario, loads
from vision.color import COLOR_CLASSES, ColorTable, load_table, save_table
from vision.errors import VisionError

from bad_input import keys, model_changed, mutated, near, value, values_changed, written

TICKS = 100  # of a run
MODEL_TICKS = 20  # of a run with a damaged model
MODELS = ("hsr8/hsr8.xml", "field/vision.xml")
SLOW = 10.0  # processor time of a case above which it is reported [s]
COMMANDS: tuple[tuple[str, ...], ...] = (
    ("info", "RUN"),
    ("info", "RUN", "--json"),
    ("diff", "RUN", "OTHER"),
    ("compare", "RUN", "OTHER"),
    ("verify", "RUN"),
    ("plot", "RUN", "--out", "PNG"),
    ("render", "RUN", "--out", "PNG", "--size", "64x48", "--camera", "head", "--quiet"),
    ("replay", "RUN"),
    ("check", "SCENARIO"),
)
ON_SWEEPS: tuple[tuple[str, ...], ...] = (
    ("compare", "SWEEP", "OTHER"),
    ("compare", "OTHER", "SWEEP", "--json"),
    ("sweep", "quick", "--seeds", "0:2", "--duration", "0.1", "--quiet", "--out", "SWEEP"),
)
RARE = {"verify": 0.15, "plot": 0.1, "render": 0.1}  # probability of the slow commands
RARE |= {"check": 0.3, "sweep": 0.02}
LIGHT = ("--body", "kinematic", "--camera", "analytic")
KINDS = ("text", "table", "setting", "start", "model", "folder", "sweep", "colors")
FILES = (
    run_folder.SCENARIO,
    run_folder.MANIFEST,
    run_folder.METRICS,
    CHECKSUMS,
    *(f"{name}{SUFFIX}" for name in TABLES),
)


def text_case(rng: random.Random) -> None:
    """Load a built-in scenario with damaged text."""
    name = rng.choice(built_in_names())
    raw = mutated(rng, (BUILT_IN / f"{name}.toml").read_bytes())
    loads(raw.decode("utf-8", errors="replace"), name)


def table_case(rng: random.Random, schema: list[tuple[str, dict[str, Any]]]) -> None:
    """Load a built-in scenario with some keys near their limits."""
    settings = []
    for key, node in rng.sample(schema, rng.randrange(1, 4)):
        settings.append(f"{key}={written(near(rng, node))}")
    load_scenario(rng.choice(built_in_names()), settings)


def start_case(rng: random.Random, schema: list[tuple[str, dict[str, Any]]]) -> None:
    """Run the first ticks with some keys near their limits."""
    settings = ['camera.source="analytic"', "camera.width=64", "camera.height=48"]
    for key, node in rng.sample(schema, rng.randrange(1, 3)):
        settings.append(f"{key}={written(near(rng, node))}")
    scenario = load_scenario(rng.choice(built_in_names()), settings)
    if scenario.camera.source == "rendered":
        return
    with Simulation(scenario, rng.randrange(3)) as simulation:
        for _ in range(TICKS):
            if simulation.exit_reason is None:
                simulation.step()


def model_case(rng: random.Random) -> None:
    """Run the first ticks with a damaged model of the robot or the field."""
    body = rng.choice(("full", "kinematic"))
    scenario = load_scenario("quick", (f'robot.body="{body}"', 'camera.source="analytic"'))
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch) / "models"
        shutil.copytree(models.models_dir(), copy)
        file = copy / rng.choice(MODELS)
        file.write_text(model_changed(rng, file.read_text(encoding="utf-8")), encoding="utf-8")
        with (
            patch.object(models, "PACKAGE", copy.parent / "hsr8"),
            Simulation(scenario, 0) as simulation,
        ):
            for _ in range(MODEL_TICKS):
                if simulation.exit_reason is None:
                    simulation.step()


def setting_case(rng: random.Random, schema: list[tuple[str, dict[str, Any]]]) -> None:
    """Load a scenario with a damaged ``--set``."""
    key = rng.choice(schema)[0]
    word = f"{key}={written(value(rng))}"
    if rng.random() < 0.7:
        word = mutated(rng, word.encode()).decode("utf-8", errors="replace")
    load_scenario(rng.choice(built_in_names()), (word,))


class Folders:
    """Damaged copies of a run, a sweep and a colour table, and commands on them.

    Args:
        run: complete run folder.
        scratch: folder of the copies.
        sweep: folder of a sweep; None for cases without one.
    """

    def __init__(self, run: Path, scratch: Path, sweep: Path | None = None) -> None:
        self._scratch = scratch
        self._run, self._contents = run, contents_of(run, FILES)
        self._sweep = sweep
        if sweep is not None:
            names = (sweep_folder.DEFINITION, sweep_folder.RESULTS, run_folder.SCENARIO)
            self._of_sweep = contents_of(sweep, names)
        save_table(ColorTable(COLOR_CLASSES), scratch / "colors.npz")
        self._colors = contents_of(scratch, ("colors.npz",))

    def damaged(self, rng: random.Random, whole: dict[str, bytes]) -> Path:
        """Return a new copy with one or two damaged files."""
        path = self._scratch / "copy"
        shutil.rmtree(path, ignore_errors=True)
        path.mkdir()
        contents = dict(whole)
        for name in rng.sample(sorted(contents), min(len(contents), rng.choice((1, 1, 2)))):
            kind = rng.randrange(5)
            if kind == 0 and len(whole) > 1:
                del contents[name]
            elif kind == 1 and len(whole) > 1:
                contents[name] = whole[rng.choice(sorted(whole))]
            elif kind == 2 and name.endswith((".json", ".jsonl")):
                contents[name] = values_changed(rng, contents[name])
            else:
                contents[name] = mutated(rng, contents[name])
        for name, content in contents.items():
            (path / name).write_bytes(content)
        return path

    def case(self, rng: random.Random, commands: tuple[tuple[str, ...], ...] = ()) -> None:
        """Run a command on a damaged run or sweep.

        Raises:
            AssertionError: as `ask`.
        """
        commands = commands or COMMANDS
        of_run = commands is not ON_SWEEPS
        path = self.damaged(rng, self._contents if of_run else self._of_sweep)
        command = rng.choice(commands)
        while rng.random() > RARE.get(command[0], 1.0):
            command = rng.choice(commands)
        out = self._scratch / "out"
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir()
        places = {"RUN": path, "SWEEP": path, "OTHER": self._run if of_run else self._sweep}
        places |= {"PNG": out / "p.png", "SCENARIO": path / "scenario.toml"}
        words = [str(places.get(word, word)) for word in command]
        ask([*words[0].split(), *words[1:]])

    def colors_case(self, rng: random.Random) -> None:
        """Read a damaged colour table."""
        load_table(self.damaged(rng, self._colors) / "colors.npz")


def contents_of(folder: Path, names: tuple[str, ...]) -> dict[str, bytes]:
    """Return the bytes of the files that exist."""
    return {name: (folder / name).read_bytes() for name in names if (folder / name).exists()}


def ask(words: list[str]) -> None:
    """Run a command line.

    Raises:
        AssertionError: the exit code is not 0, 1 or 2, or there is a traceback or no message.
    """
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = entry(words)
    message = err.getvalue()
    assert code in (0, 1, 2), f"{words}: exit {code}: {message[-500:]}"
    assert "Traceback" not in message, f"{words}: {message[-500:]}"
    assert code != 2 or message.strip(), f"{words}: exit 2 without a message"


def one(rng: random.Random, kind: str, folders: Folders | None, schema: list[Any]) -> str:
    """Run one case; return ``valid`` or ``refused``."""
    try:
        if kind == "text":
            text_case(rng)
        elif kind == "table":
            table_case(rng, schema)
        elif kind == "start":
            start_case(rng, schema)
        elif kind == "setting":
            setting_case(rng, schema)
        elif kind == "model":
            model_case(rng)
        else:
            assert folders is not None
            if kind == "colors":
                folders.colors_case(rng)
            else:
                folders.case(rng, ON_SWEEPS if kind == "sweep" else COMMANDS)
    except (ScenarioError, SimulationDiverged, UsageError, VisionError) as error:
        return "refused" if str(error).strip() else "BUG: an error without a message"
    return "valid"


def made(scratch: Path) -> tuple[Path, Path]:
    """Make a run as a kill leaves it, with its log, and a sweep of two runs."""
    short = ("quick", *LIGHT, "--quiet", "--duration")
    ask(["run", *short, "1.2", "--out", str(scratch)])
    (run,) = (scratch / "quick").iterdir()
    manifest = run / run_folder.MANIFEST
    manifest.write_text(manifest.read_text().replace('"timeout"', '"running"'))
    sweep = scratch / "sweep"
    ask(["sweep", *short, "0.1", "--seeds", "0:2", "--out", str(sweep)])
    return run, sweep


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    arguments = parser.parse_args()
    schema, counts, slowest = keys(), Counter[str](), (0.0, "")
    with tempfile.TemporaryDirectory() as scratch:
        run, sweep = made(Path(scratch))
        folders = Folders(run, Path(scratch), sweep)
        for number in range(arguments.first, arguments.first + arguments.cases):
            kind = arguments.kinds[number % len(arguments.kinds)]
            began = clock.process_time()
            try:
                result = one(random.Random(number), kind, folders, schema)
            except KeyboardInterrupt:
                raise
            except BaseException as error:  # a bug; panics of Rust are not Exceptions
                result = "BUG"
                text = f"{type(error).__name__}: {error}".replace("\n", " | ")
                print(f"case {number} ({kind}): {text[:700]}", flush=True)
            took = clock.process_time() - began
            slowest = max(slowest, (took, kind))
            if took > SLOW:
                print(f"case {number} ({kind}): took {took:.1f} s", flush=True)
            counts[f"{kind}, {result}"] += 1
    took, kind = slowest
    print(f"{arguments.cases} cases, slowest {took:.1f} s ({kind}): {dict(sorted(counts.items()))}")


if __name__ == "__main__":
    main()
