"""``hsr8 sweep``: one scenario over many seeds, and over values of its keys."""

import hashlib
import itertools
import re
import sys
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from pathlib import Path

from rich.console import Console
from rich.table import Table

from hsr8.cli.command_line import command_words, flat, option_tables, run_options, settings
from hsr8.cli.options import Sweep
from hsr8.errors import INTERRUPTED, Hsr8Error, UsageError
from hsr8.files import atomic
from hsr8.files.text import shell_line
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.sweep.folder import REPORT
from hsr8.sweep.report import headline, report_of_values
from hsr8.sweep.runs import Execution, run_sweeps
from hsr8.sweep.seeds import parse_seeds, parse_values
from hsr8.sweep.summary import Summary, summarize

MAX_NAME = 120  # of a folder [characters]


def main(options: Sweep) -> int:
    """Run the seeds without a result, write the results and report them."""
    execution = Execution(
        command=shell_line(command_words(options)),
        seeds=parse_seeds(options.seeds),
        workers=options.workers,
        executor=options.executor,
        timeout=options.timeout,
        keep=options.keep,
        quiet=options.quiet,
    )
    combinations = _combinations(options)
    scenarios = {name: _scenario(options, more) for name, more in combinations.items()}
    out = options.out or Path("sweeps") / next(iter(scenarios.values())).name
    commands = {
        name: command_words(run_options(options, None, more)) for name, more in combinations.items()
    }
    runs = run_sweeps(out, scenarios, commands, execution)
    summaries = {name: summarize(results) for name, results in runs.results.items()}
    if options.vary:
        keys = ", ".join(parse_values(text)[0] for text in flat(options.vary))
        made_with = runs.definition.made_with()
        page = report_of_values(keys, summaries, execution.command, made_with)
        try:
            atomic.write_text(out / REPORT, page)
        except OSError as error:
            raise Hsr8Error(f"{out / REPORT}: cannot write: {error.strerror}") from error
    _print(options, out, summaries, interrupted=runs.interrupted)
    return INTERRUPTED if runs.interrupted else _exit_code(list(summaries.values()))


def _combinations(options: Sweep) -> dict[str, tuple[str, ...]]:
    """Return the settings of every combination of varied values by the name of its folder."""
    varied = [parse_values(text) for text in flat(options.vary)]
    keys = [key for key, _ in varied]
    if len(set(keys)) < len(keys):
        raise UsageError("--vary: a key is repeated; expected all its values in one --vary")
    grid = itertools.product(*([f"{key}={value}" for value in values] for key, values in varied))
    return {folder_name(combination): combination for combination in grid}


def _scenario(options: Sweep, varied: tuple[str, ...]) -> Scenario:
    require_no_seed("--set", settings(options))
    require_no_seed("--vary", varied)
    return load_scenario(
        options.scenario,
        settings(options),
        options=option_tables(options),
        more={"--vary": varied},
        trust=options.trust or None,
    )


def _print(options: Sweep, out: Path, summaries: dict[str, Summary], *, interrupted: bool) -> None:
    if options.json:
        values = {name: asdict(summary) for name, summary in summaries.items()}
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
    report_lost_runs(summaries.values(), out / REPORT)


def _exit_code(summaries: Sequence[Summary]) -> int:
    """Return 3 if a run crashed or diverged, 2 if all were refused, 1 if one failed, else 0."""
    if any(s.crashed or s.diverged for s in summaries):
        return 3
    if any(s.refused and not s.runs for s in summaries):
        return 2
    return 0 if all(s.criteria_met.count == s.runs for s in summaries) else 1


def folder_name(parts: Sequence[str]) -> str:
    """Return settings as a file name, with a digest if characters are replaced or cut.

    Args:
        parts: settings KEY=VALUE, or other parts of the name.
    """
    text = ",".join(parts)
    name = re.sub(r"[^A-Za-z0-9._=+,-]+", "_", text)
    if name == text and len(name) <= MAX_NAME:
        return name
    digest = hashlib.sha256(text.encode("utf-8", errors="surrogateescape")).hexdigest()[:8]
    return f"{name[: MAX_NAME - 9]}-{digest}"


def require_no_seed(option: str, given: Iterable[str], expected: str = "--seeds") -> None:
    """Check that no setting is the seed.

    Args:
        option: option with the settings, for the message.
        given: settings KEY=VALUE.
        expected: option or source of the seeds, for the message.

    Raises:
        UsageError: a setting is the seed.
    """
    for setting in given:
        if setting.partition("=")[0].strip() == "seed":
            raise UsageError(
                f"{option}: the seed is not a setting, got {setting}; expected {expected}"
            )


def report_lost_runs(summaries: Iterable[Summary], where: Path) -> None:
    """Print the numbers of crashed, diverged and refused runs on standard error, if any.

    Args:
        summaries: summaries of sweeps.
        where: file with the reasons.
    """
    summaries = list(summaries)
    counts = {
        kind: sum(getattr(s, kind) for s in summaries)
        for kind in ("crashed", "diverged", "refused")
    }
    if any(counts.values()):
        runs = sum(s.runs + s.refused for s in summaries)
        text = ", ".join(f"{count} {kind}" for kind, count in counts.items() if count)
        print(f"hsr8: of {runs} runs {text}; reasons: {where}", file=sys.stderr)
