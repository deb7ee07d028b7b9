"""``hsr8 sweep``: one scenario over many seeds, and over values of its keys."""

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
from hsr8.cli.command_line import command_words, flat, option_tables, run_options, settings
from hsr8.cli.main import entry
from hsr8.cli.options import Sweep
from hsr8.errors import Hsr8Error, UsageError
from hsr8.evaluation.sweep.dask_executor import DaskExecutor
from hsr8.evaluation.sweep.definition import Definition
from hsr8.evaluation.sweep.executor import Executor, parse_executor, pending, run_jobs
from hsr8.evaluation.sweep.folder import REPORT, SweepFolder
from hsr8.evaluation.sweep.job import Job, RunResult
from hsr8.evaluation.sweep.local_executor import LocalExecutor
from hsr8.evaluation.sweep.progress import SweepProgress
from hsr8.evaluation.sweep.report import headline, report, report_of_values
from hsr8.evaluation.sweep.seeds import parse_seeds, parse_shard, parse_values
from hsr8.evaluation.sweep.summary import Summary, summarize
from hsr8.gl import require_gl
from hsr8.plugin_file import digests, require_plugins
from hsr8.recorder.files import atomic
from hsr8.robots.locate import digest
from hsr8.scenario.loader import dump, load_scenario
from hsr8.scenario.schema import Scenario

PRELOAD = "hsr8.cli.sweep_preload"
START_TIME = 60.0  # default limits: for the start of a process [s]
MAX_SLOWNESS = 20.0  # and wall time per simulated second [1]
MAX_NAME = 120  # of a folder [characters]
INTERRUPTED = 130


def main(options: Sweep) -> int:
    """Run the seeds without a result, write the results and report them.

    Raises:
        UsageError: the scenario, a plugin, an option or the folder is invalid.
        RenderingUnavailable: the camera needs OpenGL and there is none.
    """
    seeds = parse_seeds(options.seeds)
    shard = None if options.shard is None else parse_shard(options.shard)
    workers = len(os.sched_getaffinity(0)) if options.workers is None else options.workers
    if workers < 1:
        raise UsageError(f"--workers: out of range, got {workers}; expected at least 1")
    if options.timeout is not None and not options.timeout > 0.0:
        raise UsageError(
            f"--timeout: out of range, got {options.timeout:g}; expected more than 0 s"
        )
    address = parse_executor(options.executor)
    combinations = _combinations(options)
    scenarios = {name: _scenario(options, more) for name, more in combinations.items()}
    if not address and any(s.camera.source == "rendered" for s in scenarios.values()):
        require_gl()
    for scenario in scenarios.values():
        require_plugins(scenario.plugin)
    out = options.out or Path("sweeps") / next(iter(scenarios.values())).name
    definitions = _definitions(scenarios, options, combinations)
    command = shlex.join(command_words(options))
    folders: dict[str, SweepFolder] = {}
    jobs: list[Job] = []
    with ExitStack() as stack:
        for name, scenario in scenarios.items():
            folder = SweepFolder.open(out / name, definitions[name])
            folder.lock(shard)
            stack.callback(folder.close)
            folders[str(folder.path.resolve())] = folder
            limit = options.timeout or START_TIME + MAX_SLOWNESS * scenario.duration
            path, text = str(folder.path.resolve()), folder.definition.scenario
            jobs += [
                Job(seed, path, text, limit, log=options.log, keep=options.keep)
                for seed in pending(seeds, folder.results(), shard)
            ]
        total = len(pending(seeds, (), shard)) * len(folders)
        interrupted = bool(jobs) and _run(options, jobs, folders, workers, total)
        summaries = {}
        for name, folder in zip(scenarios, folders.values(), strict=True):
            results = folder.results()
            folder.write_report(report(folder.definition, results, command))
            summaries[name] = summarize(results)
        if options.vary:
            keys = ", ".join(parse_values(text)[0] for text in flat(options.vary))
            page = report_of_values(keys, summaries, command, folder.definition.made_with())
            try:
                atomic.write_text(out / REPORT, page)
            except OSError as error:
                raise Hsr8Error(f"{out / REPORT}: cannot write: {error.strerror}") from error
    _print(options, out, summaries, interrupted=interrupted)
    if interrupted:
        print(f"hsr8: interrupted; continue with: {command}", file=sys.stderr)
        return INTERRUPTED
    return _exit_code(list(summaries.values()))


def _definitions(
    scenarios: dict[str, Scenario], options: Sweep, combinations: dict[str, tuple[str, ...]]
) -> dict[str, Definition]:
    common = Definition.now("", (), "")
    return {
        name: replace(
            common,
            name=scenario.name,
            command_words=command_words(run_options(options, None, combinations[name])),
            libraries=common.libraries | digests(scenario.plugin) | digest(scenario.robot.model),
            scenario=dump(scenario),
        )
        for name, scenario in scenarios.items()
    }


def _run(
    options: Sweep,
    jobs: Sequence[Job],
    folders: dict[str, SweepFolder],
    workers: int,
    total: int,
) -> bool:
    """Run the jobs; return whether they were interrupted."""
    progress = None if options.quiet else SweepProgress(total, total - len(jobs))

    def on_result(job: Job, result: RunResult) -> None:
        folder = folders[job.folder]
        folder.append(result | {"command": folder.definition.command(job.seed)})
        if progress is not None:
            progress.on_result(result)

    with ExitStack() as stack:
        if progress is not None:
            stack.callback(progress.close)
        stack.enter_context(termination.like_ctrl_c())
        try:
            executor = stack.enter_context(closing(open_executor(options.executor, workers)))
            run_jobs(jobs, executor, on_result, progress.refresh if progress else lambda: None)
        except KeyboardInterrupt:
            return True
    return False


def open_executor(name: str, workers: int) -> Executor:
    """Return the executor called `name`; `workers` is for this machine only."""
    address = parse_executor(name)
    return DaskExecutor(address) if address else LocalExecutor(workers, entry, PRELOAD)


def _combinations(options: Sweep) -> dict[str, tuple[str, ...]]:
    """Return the settings of every combination of varied values by the name of its folder."""
    varied = [parse_values(text) for text in flat(options.vary)]
    keys = [key for key, _ in varied]
    if len(set(keys)) < len(keys):
        raise UsageError("--vary: a key is repeated; expected all its values in one --vary")
    grid = itertools.product(*([f"{key}={value}" for value in values] for key, values in varied))
    return {_folder_name(combination): combination for combination in grid}


def _folder_name(combination: Sequence[str]) -> str:
    """Return the settings as a file name, with a digest if characters are replaced or cut."""
    text = ",".join(combination)
    name = re.sub(r"[^A-Za-z0-9._=+,-]+", "_", text)
    if name == text and len(name) <= MAX_NAME:
        return name
    digest = hashlib.sha256(text.encode("utf-8", errors="surrogateescape")).hexdigest()[:8]
    return f"{name[: MAX_NAME - 9]}-{digest}"


def _scenario(options: Sweep, varied: tuple[str, ...]) -> Scenario:
    for option, words in (("--set", settings(options)), ("--vary", varied)):
        for word in words:
            if word.partition("=")[0].strip() == "seed":
                raise UsageError(f"{option}: the seed is not a setting, got {word}; use --seeds")
    return load_scenario(
        options.scenario, settings(options), options=option_tables(options), varied=varied
    )


def _print(options: Sweep, out: Path, summaries: dict[str, Summary], *, interrupted: bool) -> None:
    if options.json:
        values = {name: summary.to_json() for name, summary in summaries.items()}
        results = {"values": values} if options.vary else next(iter(values.values()))
        print(atomic.dumps({"folder": str(out), "interrupted": interrupted, **results}))
    elif not options.quiet:
        console = Console(highlight=False)
        for name, summary in summaries.items():
            table = Table(title=name or str(out), title_justify="left", show_header=False)
            for label, text in headline(summary):
                table.add_row(label, text)
            console.print(table)
        console.print(f"report      {out / REPORT}", soft_wrap=True, markup=False)
    counts = {
        kind: sum(getattr(s, kind) for s in summaries.values())
        for kind in ("crashed", "diverged", "refused")
    }
    if any(counts.values()):
        runs = sum(s.runs + s.refused for s in summaries.values())
        text = ", ".join(f"{count} {kind}" for kind, count in counts.items() if count)
        print(f"hsr8: of {runs} runs {text}; reasons: {out / REPORT}", file=sys.stderr)


def _exit_code(summaries: Sequence[Summary]) -> int:
    """Return 3 if a run crashed or diverged, 2 if all were refused, 1 if one failed, else 0."""
    if any(s.crashed or s.diverged for s in summaries):
        return 3
    if any(s.refused and not s.runs for s in summaries):
        return 2
    return 0 if all(s.criteria_met.count == s.runs for s in summaries) else 1
