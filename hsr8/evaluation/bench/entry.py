"""Entry of a benchmark: versions, settings and all runs, in one JSON file."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from hsr8.errors import UsageError
from hsr8.evaluation.bench.score import Score, score
from hsr8.evaluation.sweep.definition import Differences
from hsr8.evaluation.sweep.job import CRASHED, OUTCOMES, REFUSED, RunResult
from hsr8.recorder.files import atomic

FILE = "bench.json"  # in the folder of an entry
FORMAT = 1
ALL = "all"  # name of the score of all families
COLUMNS = (
    *("seed", "outcome", "success", "exit_reason", "collisions", "collisions_moving", "falls"),
    *("time_to_goal_s", "certified_time_s", "path_length_m", "certified_length_m"),
    *("min_clearance_m", "head_travel_radps", "state_hash"),
)
"""Kept of every run."""
DIGITS = 4  # of numbers of runs, after the point


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """Entry of a benchmark.

    Attributes:
        name: name in tables.
        suite: name of the suite.
        suite_version: its version.
        suite_hash: digest of its worlds, missions, robot and camera.
        seeds: "quick" or "full".
        command: command line that repeats it.
        settings: settings that differ from the standard, with both values as JSON.
        versions: versions of hsr8, its libraries and plugins.
        scenarios: digest of the scenario by family.
        runs: results of the runs by family, with `COLUMNS`.
    """

    name: str
    suite: str
    suite_version: int
    suite_hash: str
    seeds: str
    command: str
    settings: Differences
    versions: dict[str, str]
    scenarios: dict[str, str]
    runs: dict[str, list[RunResult]]

    def scores(self) -> dict[str, Score]:
        """Return the score by family, and that of all families."""
        all_runs = [run for runs in self.runs.values() for run in runs]
        return {name: score(runs) for name, runs in {**self.runs, ALL: all_runs}.items()}

    def to_json(self) -> dict[str, Any]:
        """Return plain values by name, with the scores."""
        return {
            "format": FORMAT,
            "name": self.name,
            "suite": self.suite,
            "suite_version": self.suite_version,
            "suite_hash": self.suite_hash,
            "seeds": self.seeds,
            "command": self.command,
            "settings": {key: list(pair) for key, pair in self.settings.items()},
            "versions": self.versions,
            "scenarios": self.scenarios,
            "scores": {name: part.to_json() for name, part in self.scores().items()},
            "runs": self.runs,
        }

    def text(self) -> str:
        """Return the JSON file, with a line per run."""
        value = self.to_json()
        families = [
            f"    {atomic.dumps(family)}: [\n      "
            + ",\n      ".join(map(atomic.dumps, runs))
            + "\n    ]"
            for family, runs in value.pop("runs").items()
        ]
        head = atomic.dumps(value, indent=2).removesuffix("\n}")
        return f'{head},\n  "runs": {{\n' + ",\n".join(families) + "\n  }\n}\n"

    @classmethod
    def from_json(cls, value: Mapping[str, Any]) -> Self:
        """Read the result of `to_json`.

        Raises:
            KeyError, TypeError, ValueError: `value` is not such a result.
        """
        if value["format"] != FORMAT:
            raise ValueError(f"format: got {value['format']}; expected {FORMAT}")
        fields = {key: value[key] for key in cls.__dataclass_fields__}
        settings = {str(key): (str(a), str(b)) for key, (a, b) in value["settings"].items()}
        for runs in value["runs"].values():
            for run in runs:
                _require_result(run)
        return cls(**fields | {"settings": settings})


def read_entry(path: Path) -> Entry:
    """Read the entry in a folder or a file.

    Raises:
        UsageError: there is no entry.
    """
    file = path / FILE if path.is_dir() else path
    try:
        return Entry.from_json(json.loads(file.read_text(encoding="utf-8")))
    except FileNotFoundError:
        raise UsageError(f"{path}: not an entry of `hsr8 bench`, {file} is missing") from None
    except OSError as error:
        raise UsageError(f"{path}: cannot read {file}: {error.strerror}") from error
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        text = f"{type(error).__name__}: {error}"
        raise UsageError(f"{path}: {file} is not an entry of `hsr8 bench`, {text}") from error


def row(result: RunResult) -> RunResult:
    """Return what an entry keeps of the result of a run."""
    values = {key: result.get(key) for key in COLUMNS}
    return {k: round(v, DIGITS) if isinstance(v, float) else v for k, v in values.items()}


def _require_result(run: RunResult) -> None:
    if run["outcome"] not in (*OUTCOMES.values(), CRASHED, REFUSED):
        raise ValueError(f"outcome: got {run['outcome']!r}")
    if missing := set(COLUMNS) - run.keys():
        raise ValueError(f"runs without {', '.join(sorted(missing))}")
