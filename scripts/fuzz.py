"""Fuzz test: each random input must work or be refused with a message.

    python scripts/fuzz.py --cases 50000

Damaged folders of runs and sweeps are in `tests/hsr8/test_hostile_folders.py`.
"""

import argparse
import random
import shutil
import tempfile
import time as clock
from collections import Counter
from pathlib import Path
from typing import Any
from unittest.mock import patch

from hsr8.errors import ScenarioError, SimulationDiverged, UsageError
from hsr8.loop import Simulation
from hsr8.robots import models
from hsr8.scenario.layers import BUILT_IN, built_in_names
from hsr8.scenario.loader import load_scenario, loads
from vision.color import COLOR_CLASSES, ColorTable, load_table, save_table
from vision.errors import VisionError

from bad_input import keys, model_changed, mutated, near, value, written

TICKS = 100  # of a run
MODEL_TICKS = 20  # of a run with a damaged model
MODELS = ("hsr8/hsr8.xml", "field/vision.xml")
SLOW = 10.0  # processor time of a case above which it is reported [s]
KINDS = ("text", "table", "setting", "start", "model", "colors")


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


def colors_case(rng: random.Random) -> None:
    """Read a damaged colour table."""
    with tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch) / "colors.npz"
        save_table(ColorTable(COLOR_CLASSES), file)
        file.write_bytes(mutated(rng, file.read_bytes()))
        load_table(file)


def one(rng: random.Random, kind: str, schema: list[Any]) -> str:
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
            colors_case(rng)
    except (ScenarioError, SimulationDiverged, UsageError, VisionError) as error:
        return "refused" if str(error).strip() else "BUG: an error without a message"
    return "valid"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    arguments = parser.parse_args()
    schema, counts, slowest = keys(), Counter[str](), (0.0, "")
    for number in range(arguments.first, arguments.first + arguments.cases):
        kind = arguments.kinds[number % len(arguments.kinds)]
        began = clock.process_time()
        try:
            result = one(random.Random(number), kind, schema)
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
