"""``hsr8 info``: contents of a run folder."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from hsr8.cli import report
from hsr8.cli.options import Info
from hsr8.errors import UsageError
from hsr8.evaluation.verdict import Criterion, evaluate_criteria, exit_code
from hsr8.recorder.files import atomic
from hsr8.recorder.run.manifest import RUNNING, other_versions
from hsr8.recorder.run.run_reader import Run, open_run

MAX_EVENTS = 30  # in the table; --json has all of them


def main(options: Info) -> int:
    """Show results, events, versions and files of a run.

    Raises:
        UsageError: there is no such run, or it is damaged.
    """
    run = open_run(options.run)
    if options.json:
        criteria = _criteria(run)
        contents = {
            "run": str(run.path),
            "manifest": run.manifest,
            "metrics": run.metrics(),
            "criteria_met": exit_code(run.manifest["exit_reason"], criteria) == 0,
            "criteria": [asdict(criterion) for criterion in criteria],
            "definitions": report.VERDICTS,
            "events": run.events(),
            "files": dict(_files(run.path)),
        }
        print(atomic.dumps(contents))
    else:
        _show(run)
    return 0


def _show(run: Run) -> None:
    console = Console(highlight=False)
    manifest = run.manifest
    made = Table(title=str(run.path), title_justify="left", show_header=False)
    made.add_row("scenario", f"{manifest.get('scenario', '?')}, seed {run.seed}")
    made.add_row("started", str(manifest.get("started", "?")))
    reason = manifest.get("exit_reason")
    running = "running, or killed; its records can be read"
    made.add_row("state", running if reason == RUNNING else f"ended: {reason}")
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
        criteria=_criteria(run),
        path=run.path,
        command=str(manifest.get("command", "")),
        console=console,
    )


def _criteria(run: Run) -> tuple[Criterion, ...]:
    """Return the criteria, where there are results and this version can read the scenario."""
    results = run.metrics()
    try:
        return evaluate_criteria(run.scenario().criteria, results) if results else ()
    except (UsageError, KeyError):  # made by another version
        return ()


def _table(events: tuple[dict[str, Any], ...]) -> Table:
    shown = events[-MAX_EVENTS:]
    title = "events" if shown == events else f"the last {MAX_EVENTS} of {len(events)} events"
    table = Table(title=title, title_justify="left")
    table.add_column(escape("time [s]"), justify="right")
    table.add_column("kind")
    table.add_column("event")
    for event in shown:
        table.add_row(f"{event['time']:.2f}", event["kind"], escape(event["text"]))
    return table


def _files(folder: Path) -> list[tuple[str, int]]:
    return sorted((file.name, file.stat().st_size) for file in folder.iterdir() if file.is_file())


def _size(size: int) -> str:
    return f"{size / 1e6:.1f} MB" if size >= 100_000 else f"{size / 1e3:.1f} kB"
