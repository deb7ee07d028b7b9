"""Comparison of two checkouts of hsr8: columns, metrics and log entities of the same runs.

    python scripts/compare_versions.py OLD NEW --seeds 1000:1020 --page docs/results/versions.md

OLD and NEW are checkouts, each with its environment in ``.venv``; the script is started with that
of NEW. Each scenario and seed runs in both. Three questions are answered for each run:

* again: which columns, metrics and state hashes differ, with the maximum difference;
* columns: which columns of OLD are not in NEW, and of NEW not in OLD, apart from `RENAMED`;
* from the tables of OLD: which metrics and log entities differ when NEW computes them, apart from
  `CHANGED`. It compares recording and log to the bit, even where a version walks differently.
"""

import hsr8  # noqa: F401  before NumPy

# isort: split
import argparse
import json
import shutil
import subprocess
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from hsr8.evaluation.metrics import COLUMNS, metrics
from hsr8.evaluation.sweep.seeds import parse_seeds
from hsr8.evaluation.tables import table
from hsr8.files import atomic
from hsr8.recorder.run.run_reader import StoredRun, open_run
from hsr8.rerun_log.run_log import write_log
from hsr8.world.field.generator import draw_world

import numpy as np
import pyarrow as pa
from rerun.chunk import RrdReader

SCENARIOS = ("course", "crowd", "conflict", "walk")
RENAMED: dict[str, str] = {}  # columns and metrics of OLD by their names in NEW, "" where removed
ADDED = ("frames.nearest_track", "first_collision_s", "/plots/clearance/believed")
UNREPEATABLE = ("ticks.walking_time", "wall_time_s", "real_time_factor", "walk_tick_")
CHANGED = ("/__properties", "/belief/local_map")  # start time; ground in white, not in shades

Values = dict[str, list[Any]]


def run(checkout: Path, scenario: str, seed: int, options: Sequence[str], out: Path) -> StoredRun:
    """Run a scenario in a checkout, with a log, and return the run."""
    program = checkout / ".venv" / "bin" / "hsr8"
    words = [str(program), "run", scenario, "--seed", str(seed), *options]
    log = [] if "--no-log" in _help(program) else ["--log"]  # former versions log by default
    done = subprocess.run([*words, *log, "--quiet", "--out", str(out)], check=False, cwd=out)
    if done.returncode not in (0, 1):
        raise SystemExit(f"{' '.join(words)}: exit code {done.returncode}")
    return open_run(out / scenario)


def _help(program: Path) -> str:
    return subprocess.run(
        [program, "run", "--help"], check=True, capture_output=True, text=True
    ).stdout


def columns(run: StoredRun) -> Values:
    """Return the rows of every column of every file of tables, without hsr8's reader."""
    values: Values = {}
    for file in sorted(run.path.glob("*.arrows")):
        with pa.OSFile(str(file)) as source, pa.ipc.open_stream(source) as reader:
            for name, column in reader.read_all().to_pydict().items():
                values[RENAMED.get(f"{file.stem}.{name}", f"{file.stem}.{name}")] = column
    return values


def entities(file: Path) -> Values:
    """Return times and rows of every component of every entity of a log."""
    rows: Values = defaultdict(list)
    for chunk in RrdReader(str(file)).stream():
        batch = chunk.to_record_batch()
        times = [-1] * batch.num_rows  # of a static component
        if not chunk.is_static:
            times = batch["sim_time"].cast(pa.int64()).to_pylist()
        for name in batch.schema.names:
            if ":" in name and "RowId" not in name:
                key = f"{chunk.entity_path} {name}"
                rows[key] += zip(times, batch[name].to_pylist(), strict=True)
    return {key: sorted(part, key=lambda row: row[0]) for key, part in rows.items()}


def computed_metrics(run: StoredRun) -> dict[str, Any]:
    """Return the metrics that this version computes from the tables of a run."""
    scenario, given = run.scenario(), run.metrics()
    world = draw_world(scenario, run.seed)
    results = metrics(
        {name: getattr(run, name) for name in COLUMNS},
        world.layout,
        scenario.navigation.mission,
        certificate=world.certificate,
        exit_reason=given["exit_reason"],
        state_hash=given["state_hash"],
        wall_time=given["wall_time_s"],
    )
    value: dict[str, Any] = json.loads(atomic.dumps(results))
    return value


def differing(old: dict[str, Any], new: dict[str, Any], but: tuple[str, ...]) -> Iterator[str]:
    """Yield the keys that are in one only, or whose values differ in a bit."""
    for key in sorted(old.keys() | new.keys()):
        if key.startswith((*but, *ADDED)) or (
            key in old and key in new and repr(old[key]) == repr(new[key])
        ):
            continue
        yield (
            f"{key}: only OLD" if key not in new else f"{key}: only NEW" if key not in old else key
        )


def distance(old: list[Any], new: list[Any]) -> float:
    """Return the maximum difference of two columns of numbers; infinite where shapes differ."""
    try:
        one, other = (np.array(rows, float) for rows in (old, new))
        return float(np.nanmax(np.abs(one - other), initial=0.0))
    except (TypeError, ValueError):
        return float("inf")


def main() -> None:
    """Run, compare, and print or write the page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("checkouts", type=Path, nargs=2, metavar="CHECKOUT")
    parser.add_argument("--seeds", default="1000:1002")
    parser.add_argument("--scenarios", nargs="+", default=SCENARIOS)
    parser.add_argument("--duration", default="20", help="maximum simulated time [s]")
    parser.add_argument("--body", default="full", choices=("full", "kinematic"))
    parser.add_argument("--page", type=Path, help="file of the page; default: standard output")
    given = parser.parse_args()
    options = ["--duration", given.duration, "--body", given.body]
    rows, again, recomputed = [], Counter[str](), Counter[str]()
    greatest: dict[str, float] = defaultdict(float)
    for scenario in given.scenarios:
        count = Counter[str]()
        for seed in parse_seeds(given.seeds):
            out = Path(tempfile.mkdtemp(prefix="compare-versions-"))
            pair = []
            for name, checkout in zip(("old", "new"), given.checkouts, strict=True):
                (out / name).mkdir()
                pair.append(run(checkout.resolve(), scenario, seed, options, out / name))
            old, new = pair
            a, b = columns(old), columns(new)
            differ = [*differing(a, b, UNREPEATABLE)]
            for key in differ:
                if key in a and key in b:
                    greatest[key] = max(greatest[key], distance(a[key], b[key]))
            metric = [*differing(old.metrics(), new.metrics(), UNREPEATABLE)]
            again.update([*differ, *(f"metric {key}" for key in metric)])
            log = entities(old.path / "log.rrd")
            shutil.copy(new.scenario_file, old.scenario_file)  # in the words of NEW
            computed = [*differing(old.metrics(), computed_metrics(old), UNREPEATABLE)]
            computed += differing(log, entities(write_log(old)), CHANGED)
            recomputed.update(computed)
            count.update(
                runs=1,
                hash=old.metrics()["state_hash"] == new.metrics()["state_hash"],
                columns=len(a) - len(differ),
                entities=len(log),
                recomputed=not computed,
            )
            shutil.rmtree(out)
        rows.append(tuple(map(str, (scenario, *count.values()))))
        print(*rows[-1], flush=True)
    head = ("scenario", "runs", "equal hashes", "equal columns, sum", "components of the logs, sum")
    lines = ["# Two versions", "", f"Seeds {given.seeds}, `{' '.join(options)}`.", ""]
    lines += table((*head, "metrics and log equal from the tables of OLD"), rows)
    lines += ["## Runs repeated", ""]
    lines += table(
        ("differs", "runs", "by at most"),
        [
            (key, str(n), f"{greatest[key]:.2g}" if key in greatest else "")
            for key, n in again.items()
        ],
    )
    lines += ["## From the tables of OLD", ""]
    lines += table(("differs", "runs"), [(key, str(n)) for key, n in recomputed.items()])
    text = "\n".join(lines)
    print(text) if given.page is None else given.page.write_text(text)


if __name__ == "__main__":
    main()
