"""``hsr8 sweep``: one scenario over many seeds, and over values of a setting."""

import hashlib
import itertools
import os
import re
import shlex
import sys
from collections.abc import Sequence
from contextlib import ExitStack, closing
from dataclasses import replace
from pathlib import Path

from rich.console import Console
from rich.table import Table

from hsr8.cli import termination
from hsr8.cli.command_line import flat, option_tables, run_words, settings
from hsr8.cli.options import Sweep
from hsr8.errors import Hsr8Error, UsageError
from hsr8.evaluation.sweep.definition import Definition, code_digest
from hsr8.evaluation.sweep.driver import drive, pending
from hsr8.evaluation.sweep.executor import open_executor, parse_executor
from hsr8.evaluation.sweep.folder import REPORT, SweepFolder
from hsr8.evaluation.sweep.job import Job, Row
from hsr8.evaluation.sweep.progress import SweepProgress
from hsr8.evaluation.sweep.report import headline, write_comparison_of_values, write_report
from hsr8.evaluation.sweep.seeds import parse_seeds, parse_shard, parse_values
from hsr8.evaluation.sweep.summary import Summary, summarize
from hsr8.gl import require_gl
from hsr8.plugin_file import digests, require_plugins
from hsr8.recorder.files import atomic
from hsr8.scenario.loader import dump, load_scenario
from hsr8.scenario.schema import Scenario

START = 60.0  # a process may need so long to begin [s]
SLOWEST = 20.0  # and so long for a simulated second [s]
LONGEST_TIMEOUT = 1e7  # some four months; threads cannot wait for much longer [s]
MOST_WORKERS = 1024
MOST_VARIANTS = 1000
LONGEST_NAME = 120  # of a folder [characters]
INTERRUPTED = 130
CHANGED = "hsr8: the program's files changed during the sweep: its runs are not of one version"


def main(options: Sweep) -> int:
    """Run what has no result yet, write the results, and tell them.

    Raises:
        UsageError: the scenario, a planner or a gaze that it names, the seeds, the folder or the
            executor will not do.
        RenderingUnavailable: the camera needs OpenGL and there is none.
    """
    seeds = parse_seeds(options.seeds)
    shard = None if options.shard is None else parse_shard(options.shard)
    workers = _workers(options)
    kind, _ = parse_executor(options.executor)
    if options.timeout is not None and not 0.0 < options.timeout <= LONGEST_TIMEOUT:
        raise UsageError(
            f"--timeout {options.timeout:g}: give a time above 0, at most {LONGEST_TIMEOUT:g} s"
        )
    variants = _variants(options)
    scenarios = {name: _scenario(options, more) for name, more in variants.items()}
    if kind == "local" and any(s.camera.source == "rendered" for s in scenarios.values()):
        require_gl()
    for scenario in scenarios.values():
        require_plugins(scenario.plugin)
    out = options.out or Path("sweeps") / next(iter(scenarios.values())).name
    definitions = _definitions(options, scenarios, variants)
    sweeps: dict[str, SweepFolder] = {}
    jobs: list[Job] = []
    with ExitStack() as stack:
        for name, scenario in scenarios.items():
            folder = SweepFolder.open(out / name, definitions[name])
            folder.lock(shard)
            stack.callback(folder.close)
            sweeps[str(folder.path.resolve())] = folder
            jobs += _jobs(options, folder, scenario, pending(seeds, folder.rows(), shard))
        mine = len(pending(seeds, (), shard)) * len(sweeps)
        interrupted = _run(options, jobs, sweeps, workers, mine)
        made = next(iter(definitions.values()))
        if jobs and code_digest() != made.code:
            print(CHANGED, file=sys.stderr)
        command = _command(options)
        summaries = {}
        for name, folder in zip(scenarios, sweeps.values(), strict=True):
            rows = folder.rows()
            folder.write_results(write_report(folder.definition, rows, command))
            summaries[name] = summarize(rows)
        if options.vary:
            _write_values(options, out, summaries, made.made_with(), command)
    _tell(options, out, summaries, command if interrupted else "")
    return INTERRUPTED if interrupted else _exit_code(list(summaries.values()))


def _definitions(
    options: Sweep, scenarios: dict[str, Scenario], variants: dict[str, tuple[str, ...]]
) -> dict[str, Definition]:
    """What the runs of each variant have in common."""
    common = Definition.now("", (), "")
    return {
        name: replace(
            common,
            name=scenario.name,
            again=run_words(options, variants[name]),
            libraries=common.libraries | digests(scenario.plugin),
            scenario=dump(scenario),
        )
        for name, scenario in scenarios.items()
    }


def _jobs(
    options: Sweep, folder: SweepFolder, scenario: Scenario, seeds: Sequence[int]
) -> list[Job]:
    """One for each of the seeds."""
    common = Job(
        seed=0,
        folder=str(folder.path.resolve()),
        scenario=folder.definition.scenario,
        timeout=options.timeout or START + SLOWEST * scenario.duration,
        log=options.log,
        keep=options.keep,
    )
    return [replace(common, seed=seed) for seed in seeds]


def _run(
    options: Sweep,
    jobs: Sequence[Job],
    sweeps: dict[str, SweepFolder],
    workers: int,
    mine: int,
) -> bool:
    """Run the jobs; whether they were interrupted."""
    if not jobs:
        return False
    progress = None if options.quiet else SweepProgress(mine, mine - len(jobs))

    def record(job: Job, row: Row) -> None:
        folder = sweeps[job.folder]
        folder.append([row | {"command": folder.definition.command(job.seed)}])
        if progress is not None:
            progress.on_row(row)

    with ExitStack() as stack:
        if progress is not None:
            stack.callback(progress.close)
        stack.enter_context(termination.like_ctrl_c())
        try:
            executor = stack.enter_context(closing(open_executor(options.executor, workers)))
            drive(jobs, executor, record, progress.tick if progress else lambda: None)
        except KeyboardInterrupt:
            return True
    return False


def _workers(options: Sweep) -> int:
    if options.workers is None:
        return len(os.sched_getaffinity(0))
    if not 1 <= options.workers <= MOST_WORKERS:
        raise UsageError(f"--workers {options.workers}: give 1 to {MOST_WORKERS}")
    return options.workers


def _variants(options: Sweep) -> dict[str, tuple[str, ...]]:
    """Settings of every combination of varied values, by the name of its folder."""
    varied = [parse_values(text) for text in flat(options.vary)]
    keys = [key for key, _ in varied]
    if len(set(keys)) < len(keys):
        raise UsageError("--vary names a key twice: give all its values in one")
    grid = itertools.product(*([f"{key}={value}" for value in values] for key, values in varied))
    variants = {_folder_name(combination): combination for combination in grid}
    if not 1 <= len(variants) <= MOST_VARIANTS:
        raise UsageError(f"--vary: at most {MOST_VARIANTS} combinations of values")
    return variants


def _folder_name(combination: Sequence[str]) -> str:
    """The settings as a file system takes them; a digest tells apart what this makes the same."""
    text = ",".join(combination)
    name = re.sub(r"[^A-Za-z0-9._=+,-]+", "_", text)
    if name == text and len(name) <= LONGEST_NAME:
        return name
    digest = hashlib.sha256(text.encode("utf-8", errors="surrogateescape")).hexdigest()[:8]
    return f"{name[: LONGEST_NAME - 9]}-{digest}"


def _scenario(options: Sweep, more: tuple[str, ...]) -> Scenario:
    for flag, words in (("--set", settings(options)), ("--vary", more)):
        for word in words:
            if word.partition("=")[0].strip() == "seed":
                raise UsageError(f"{flag} {word}: the seeds of a sweep are given by --seeds")
    return load_scenario(
        options.scenario, settings(options), options=option_tables(options), varied=more
    )


def _command(options: Sweep) -> str:
    words = ["hsr8", "sweep", *run_words(options)[2:], "--seeds", options.seeds]
    for group in options.vary:
        words += ["--vary", *group]
    for flag, value, default in (
        ("--out", options.out, None),
        ("--workers", options.workers, None),
        ("--executor", options.executor, "local"),
        ("--shard", options.shard, None),
        ("--timeout", options.timeout, None),
        ("--keep", options.keep, "all"),
    ):
        if value != default:
            words += [flag, str(value)]
    if options.log:
        words.append("--log")
    return shlex.join(words)


def _write_values(
    options: Sweep,
    out: Path,
    summaries: dict[str, Summary],
    made_with: str,
    command: str,
) -> None:
    keys = ", ".join(parse_values(text)[0] for text in flat(options.vary))
    try:
        atomic.write_text(
            out / REPORT, write_comparison_of_values(keys, summaries, command, made_with)
        )
    except OSError as error:
        raise Hsr8Error(f"cannot write {out / REPORT}: {error.strerror}") from error


def _tell(options: Sweep, out: Path, summaries: dict[str, Summary], go_on: str) -> None:
    if options.json:
        (first, *_) = summaries.values()
        results = (
            {"values": {name: s.to_json() for name, s in summaries.items()}}
            if options.vary
            else first.to_json()
        )
        print(atomic.dumps({"folder": str(out), "interrupted": bool(go_on), **results}))
    elif not options.quiet:
        console = Console(highlight=False)
        for name, summary in summaries.items():
            table = Table(title=name or str(out), title_justify="left", show_header=False)
            for label, text in headline(summary):
                table.add_row(label, text)
            console.print(table)
        console.print(f"report      {out / REPORT}", soft_wrap=True, markup=False)
    if told := _not_run(list(summaries.values())):
        print(f"hsr8: {told}; why: {out / REPORT}", file=sys.stderr)
    if go_on:
        print(f"hsr8: interrupted; go on with: {go_on}", file=sys.stderr)


def _not_run(summaries: Sequence[Summary]) -> str:
    """How many runs came to no end that counts, in words; nothing if there are none."""
    kinds = ("crashed", "diverged", "refused")
    counts = [(sum(getattr(s, kind) for s in summaries), kind) for kind in kinds]
    found = [f"{count} {kind}" for count, kind in counts if count]
    runs = sum(s.runs + s.refused for s in summaries)
    return f"of {runs} runs {', '.join(found)}" if found else ""


def _exit_code(summaries: Sequence[Summary]) -> int:
    """3 if a run crashed or diverged, 2 if none could be made, 1 if one failed, else 0."""
    if any(s.crashed or s.diverged for s in summaries):
        return 3
    if any(s.refused and not s.runs for s in summaries):
        return 2
    return 0 if all(s.passed.count == s.runs for s in summaries) else 1
