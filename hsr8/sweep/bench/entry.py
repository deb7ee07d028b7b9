"""Entry of a benchmark: versions, settings and all runs, in one JSON file."""

import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from annotated_types import Interval
from pydantic import TypeAdapter, ValidationError

from hsr8.errors import UsageError
from hsr8.files import atomic
from hsr8.files.tables import table
from hsr8.files.text import read_text
from hsr8.measure.registry import METRICS
from hsr8.mistakes import mistake_lines
from hsr8.scenario.section import Section
from hsr8.sweep.definition import Differences
from hsr8.sweep.folder import DEFINITION
from hsr8.sweep.job import RunResult
from hsr8.sweep.summary import Summary, summarize

FILE = "bench.json"  # in the folder of an entry
REFERENCE = Path(__file__).with_name("reference.json")  # entry of the default
FORMAT = 1
ALL = "all"  # name of the score of all families
DIGITS = 4  # of numbers of runs, after the point

Outcome = Literal["passed", "failed", "diverged", "crashed", "refused"]
Count = Annotated[int, Interval(ge=0)]
Positive = Annotated[float, Interval(gt=0.0)]
NotNegative = Annotated[float, Interval(ge=0.0)]


class Run(Section):
    """Results of a run; None is not measured."""

    seed: Count
    outcome: Outcome
    success: bool | None
    exit_reason: str | None
    collisions: Count | None
    collisions_moving: Count | None
    falls: Count | None
    time_to_goal_s: Positive | None
    certified_time_s: Positive | None
    path_length_m: NotNegative | None
    certified_length_m: Positive | None
    min_clearance_m: float | None
    head_travel_radps: NotNegative | None
    state_hash: str | None


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
        runs: results of the runs by family, each a `Run`.
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

    def scores(self) -> dict[str, Summary]:
        """Return the summary by family, and that of all families."""
        all_runs = [run for runs in self.runs.values() for run in runs]
        return {name: summarize(runs) for name, runs in {**self.runs, ALL: all_runs}.items()}

    def to_json(self) -> dict[str, Any]:
        """Return plain values by name, with the scores."""
        scores = {name: asdict(part) for name, part in self.scores().items()}
        value = asdict(self)
        runs = value.pop("runs")
        return {"format": FORMAT, **value, "scores": scores, "runs": runs}

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
    def from_json(cls, value: Any) -> Self:
        """Read the result of `to_json`.

        Raises:
            ValueError: `value` is not such a result.
        """
        if not isinstance(value, dict) or "format" not in value:
            raise ValueError("format: missing; expected a value")
        if value["format"] != FORMAT:
            raise ValueError(f"format: wrong value, got {value['format']}; expected {FORMAT}")
        fields = {key: value[key] for key in cls.__dataclass_fields__ if key in value}
        checked: tuple[Any, Any] = cls, fields
        try:
            entry = TypeAdapter(cls).validate_json(json.dumps(fields), strict=True)
            for run in (run for runs in entry.runs.values() for run in runs):
                checked = Run, run
                Run.model_validate(run)
        except ValidationError as error:
            raise ValueError(mistake_lines(error, *checked)[0]) from error
        return entry


def read_entry(path: Path) -> Entry:
    """Read the entry in a folder or a file.

    Raises:
        UsageError: there is no entry.
    """
    file = path / FILE if path.is_dir() else path
    families = sorted(part.parent.name for part in path.glob(f"*/{DEFINITION}"))
    if families and not file.exists():
        raise UsageError(
            f"{path}: the benchmark is not finished, got results of {', '.join(families)}; "
            "continue it with the same `hsr8 bench` command"
        )
    try:
        return Entry.from_json(json.loads(read_text(file)))
    except OSError as error:
        text = f"cannot be read: {error.strerror}"
    except (json.JSONDecodeError, RecursionError) as error:
        text = f"invalid JSON: {error}"
    except ValueError as error:
        text = str(error)
    raise UsageError(
        f"{file}: not an entry of hsr8 bench: {text}; expected a folder of hsr8 bench or its {FILE}"
    )


def reference_for(entry: Entry) -> Entry | None:
    """Return the shipped entry of the default on the worlds of `entry`, in families that it has.

    None if it is of another suite or has no family with all worlds of `entry`. Equal worlds have
    the same certified time.
    """
    reference = read_entry(REFERENCE)
    if (reference.suite, reference.suite_version) != (entry.suite, entry.suite_version):
        return None
    runs = {}
    for family, theirs in entry.runs.items():
        known = {run["seed"]: run for run in reference.runs.get(family, ())}
        defaults = [known[run["seed"]] for run in theirs if run["seed"] in known]
        times = [[run["certified_time_s"] for run in part] for part in (theirs, defaults)]
        if len(defaults) == len(theirs) and all(
            None in pair or pair[0] == pair[1] for pair in zip(*times, strict=True)
        ):
            runs[family] = defaults
    return replace(reference, runs=runs) if runs else None


def row(result: RunResult) -> RunResult:
    """Return what an entry keeps of the result of a run."""
    values = {key: result.get(key) for key in Run.model_fields}
    return {k: round(v, DIGITS) if isinstance(v, float) else v for k, v in values.items()}


MEDIANS = {"min_clearance_m": 3, "head_travel_radps": 2, "time_to_goal_s": 1}
"""Digits of the medians of a score."""
SCORES = [
    METRICS[name].head
    for name in ("collision", "timeout", "fall", "spl", "optimal_time_ratio", *MEDIANS)
]
SHOWN = ("hsr8", "code", "mujoco", "numpy", "scipy", "pin", "processor", "arithmetic")


def entry_page(entry: Entry) -> str:
    """Return the page of one entry: a line per family, and one of the default below it."""
    lines = [f"# {entry.name} in {_suite(entry)}, {entry.seeds} seeds", "", f"    {entry.command}"]
    lines += ["", f"{_versions(entry)}.", "", *_settings(entry)]
    head = ("family", "runs", "success", "95 % interval", *SCORES)
    reference = reference_for(entry)
    defaults = {} if reference is None else reference.scores()
    if len(defaults) <= len(entry.runs):  # a family is missing in the sum
        defaults.pop(ALL, None)
    rows = []
    for name, part in entry.scores().items():
        rows.append((name, *_cells(part)))
        if name in defaults:
            rows.append((f"{name}, default", *_cells(defaults[name])))
    if reference is not None:
        lines += [f"Lines of the default: the same worlds, {_versions(reference)}.", ""]
    return "\n".join([*lines, *table(head, rows)])


def _suite(entry: Entry) -> str:
    return f"suite {entry.suite} {entry.suite_version} ({entry.suite_hash})"


def _versions(entry: Entry) -> str:
    known = [f"{name} {entry.versions[name]}" for name in SHOWN if entry.versions.get(name)]
    return ", ".join(known)


def _settings(entry: Entry) -> list[str]:
    if not entry.settings:
        return ["All settings are those of the standard.", ""]
    rows = [(f"`{key}`", old, new) for key, (old, new) in entry.settings.items()]
    return table(("setting", "standard", "entry"), rows)


def _cells(part: Summary) -> list[str]:
    success = part.success
    interval = f"{100 * success.low:.1f} to {100 * success.high:.1f} %"
    rates = [f"{100 * p.fraction:.1f}" for p in (part.collision, part.timeout, part.fall)]
    ratios = ["" if v is None else f"{v:.3f}" for v in (part.spl, part.optimal_time_ratio)]
    medians = [
        f"{part.quantities[key].median:.{digits}f}" if key in part.quantities else ""
        for key, digits in MEDIANS.items()
    ]
    return [
        str(part.runs),
        f"{100 * success.fraction:.1f} %",
        *(interval, *rates, *ratios, *medians),
    ]
