"""``hsr8 info``: what a run folder holds."""

from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from hsr8.cli import report
from hsr8.cli.options import Info
from hsr8.errors import UsageError
from hsr8.evaluation.verdict import Criterion, evaluate_criteria
from hsr8.recorder.files import atomic
from hsr8.recorder.run.manifest import RUNNING, other_versions
from hsr8.recorder.run.run_reader import Run, open_run

SHOWN = 30  # events in a terminal; all of them with --json


def main(options: Info) -> int:
    """Tell everything about a run that fits on a page.

    Raises:
        UsageError: there is no such run, or it is damaged.
    """
    run = open_run(options.run)
    if options.json:
        print(atomic.dumps(facts(run)))
    else:
        _show(run)
    return 0


def facts(run: Run) -> dict[str, Any]:
    """Manifest, results, criteria, events and files as plain values."""
    return {
        "run": str(run.path),
        "manifest": run.manifest,
        "metrics": run.metrics(),
        "criteria": [
            {"name": c.name, "expected": c.expected, "actual": c.actual, "met": c.met}
            for c in _checks(run)
        ],
        "events": list(run.events()),
        "files": {name: size for name, size in _files(run.path)},
    }


def _show(run: Run) -> None:
    console = Console(highlight=False)
    manifest = run.manifest
    made = Table(title=str(run.path), title_justify="left", show_header=False)
    made.add_row("scenario", f"{manifest.get('scenario', '?')}, seed {run.seed}")
    made.add_row("started", str(manifest.get("started", "?")))
    made.add_row("state", _state(manifest.get("exit_reason")))
    made.add_row("made by", f"hsr8 {manifest.get('hsr8', '?')}, Python {manifest.get('python')}")
    made.add_row("on", f"{manifest.get('machine', '?')}; camera: {manifest.get('renderer', '?')}")
    for name, then, now in other_versions(manifest):
        made.add_row("other version", f"{name} was {then}, is {now}")
    console.print(made)
    events = run.events()
    if events:
        console.print(_table(events))
    files = ", ".join(f"{name} {_size(size)}" for name, size in _files(run.path))
    console.print(f"files       {files}", soft_wrap=True)
    report.show(
        "results",
        results=run.metrics(),
        checks=_checks(run),
        path=run.path,
        command=str(manifest.get("command", "")),
        console=console,
    )


def _state(reason: object) -> str:
    if reason == RUNNING:
        return "running, or it was killed; what was written can be read"
    return f"ended: {reason}"


def _checks(run: Run) -> tuple[Criterion, ...]:
    """The criteria, where there are results and this version understands the scenario."""
    results = run.metrics()
    if not results:
        return ()
    try:
        return evaluate_criteria(run.scenario().criteria, results)
    except (UsageError, KeyError):  # made by another version
        return ()


def _table(events: tuple[dict[str, Any], ...]) -> Table:
    title = "events" if len(events) <= SHOWN else f"the last {SHOWN} of {len(events)} events"
    table = Table(title=title, title_justify="left")
    table.add_column(escape("time [s]"), justify="right")
    table.add_column("kind")
    table.add_column("what happened")
    for event in events[-SHOWN:]:
        table.add_row(f"{event['time']:.2f}", event["kind"], escape(event["text"]))
    return table


def _files(folder: Path) -> list[tuple[str, int]]:
    return sorted((file.name, file.stat().st_size) for file in folder.iterdir() if file.is_file())


def _size(size: int) -> str:
    return f"{size / 1e6:.1f} MB" if size >= 100_000 else f"{size / 1e3:.1f} kB"
