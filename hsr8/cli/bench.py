"""``hsr8 bench``: the families of a suite with fixed seeds, one table and one JSON file."""

from dataclasses import replace
from pathlib import Path

from hsr8.cli.command_line import command_words, settings
from hsr8.cli.options import Bench, Run
from hsr8.cli.sweep import folder_name, report_lost_runs, require_no_seed
from hsr8.errors import INTERRUPTED, Hsr8Error, UsageError
from hsr8.files import atomic
from hsr8.files.text import shell_line
from hsr8.sweep.bench.entry import FILE, Entry, entry_page, row
from hsr8.sweep.bench.suite import (
    SHIPPED,
    changed_settings,
    checked_name,
    read_suite,
    scenario_hash,
)
from hsr8.sweep.folder import REPORT
from hsr8.sweep.runs import Execution, run_sweeps
from hsr8.sweep.seeds import parse_seeds
from hsr8.sweep.summary import summarize

DEFAULT = "default"  # name of an entry without settings


def main(options: Bench) -> int:
    """Run the worlds of the suite that have no result, write the entry and print its table."""
    file = options.suite or SHIPPED
    suite = read_suite(file)
    seeds = "quick" if options.quick else "full"
    execution = Execution(
        command=shell_line(command_words(options)),
        seeds=parse_seeds(suite.quick if options.quick else suite.full),
        workers=options.workers,
        timeout=options.timeout,
        keep=options.keep,
        quiet=options.quiet,
    )
    words = _settings(options)
    standard, scenarios = suite.scenarios(file), suite.scenarios(file, words)
    changed = changed_settings(standard, scenarios)
    names = _names(options, words)
    parent = Path("bench") if options.suite is None else Path("bench") / suite.name
    out = options.out or parent / folder_name(names)
    commands = {
        family: command_words(Run(path, set=((*suite.settings, *words),)))
        for family, path in suite.paths(file).items()
    }
    runs = run_sweeps(out, scenarios, commands, execution)
    if runs.interrupted:
        return INTERRUPTED
    results = {
        family: [r for r in results if r["seed"] in execution.seeds]
        for family, results in runs.results.items()
    }
    entry = Entry(
        name=", ".join(names),
        suite=suite.name,
        suite_version=suite.version,
        suite_hash=suite.digest(standard),
        seeds=seeds,
        command=_command(options),
        settings=changed,
        versions=runs.definition.versions(),
        scenarios={family: scenario_hash(scenario) for family, scenario in scenarios.items()},
        runs={family: [row(r) for r in part] for family, part in results.items()},
    )
    _write(options, out, entry)
    summaries = [summarize(part) for part in results.values()]
    report_lost_runs(summaries, out / "*" / REPORT)
    if any(s.crashed or s.diverged for s in summaries):
        return 3
    return 0 if any(s.runs for s in summaries) else 2


def _settings(options: Bench) -> tuple[str, ...]:
    """Return all settings of the entry as KEY=VALUE."""
    require_no_seed("--set", settings(options), "those of the suite")
    words = (("robot.body", options.body), ("camera.source", options.camera))
    given = tuple(f"{key}={value}" for key, value in words if value is not None)
    return (*given, *settings(options))


def _names(options: Bench, words: tuple[str, ...]) -> tuple[str, ...]:
    """Return the name of the entry, or its settings.

    Raises:
        UsageError: it is not a name.
    """
    if options.name is None:
        return words or (DEFAULT,)
    try:
        return (checked_name(options.name),)
    except ValueError as error:
        raise UsageError(f"--name: {error}") from None


def _command(options: Bench) -> str:
    """Return the command line that repeats the entry anywhere."""
    here = replace(options, out=None, workers=None, timeout=None, keep=Bench.keep)
    return shell_line(command_words(here))


def _write(options: Bench, out: Path, entry: Entry) -> None:
    page = entry_page(entry)
    try:
        atomic.write_text(out / FILE, entry.text())
        atomic.write_text(out / REPORT, page)
    except OSError as error:
        raise Hsr8Error(f"{out}: cannot write the entry: {error.strerror}") from error
    if options.json:
        print(atomic.dumps({"folder": str(out), **entry.to_json()}))
    elif not options.quiet:
        print(f"{page}\nreport      {out / REPORT}\nentry       {out / FILE}")
