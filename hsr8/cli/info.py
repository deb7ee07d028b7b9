"""``hsr8 info``: contents of a run folder."""

from collections.abc import Sequence
from dataclasses import asdict

from rich.console import Console

from hsr8.cli import report, tables
from hsr8.cli.citation import BIBTEX
from hsr8.cli.options import Info
from hsr8.errors import UsageError, escaped
from hsr8.files import atomic
from hsr8.measure.registry import METRICS, Shown, shown_in
from hsr8.recording.manifest import RUNNING, other_versions
from hsr8.recording.run import Run, open_run
from hsr8.recording.verdict import Criterion, exit_code

PLAIN = (  # first rows of the table
    *("success", "exit_reason", "time_to_goal_s", "path_length_m", "collisions", "falls"),
    *("via_points_passed", "min_clearance_m"),
)
MAX_EVENTS = 30  # in the table; --json has all of them


def main(options: Info) -> int:
    """Show results, events, versions and files of a run, or the references."""
    if options.bibtex:
        print(BIBTEX, end="")
        return 0
    if options.run is None:
        raise UsageError("RUN: missing; expected a run folder, or --bibtex")
    run = open_run(options.run)
    manifest, results, criteria = run.manifest, run.metrics, _criteria(run)
    events = [vars(event) for event in run.events.objects("time", "kind", "text")]
    files = {f.name: f.stat().st_size for f in sorted(run.folder.iterdir()) if f.is_file()}
    if options.json:
        met = exit_code(str(manifest.get("exit_reason")), criteria) == 0
        contents = {
            "run": str(run.folder),
            "manifest": manifest,
            "metrics": results,
            "criteria_met": met if criteria else None,
            "criteria": [asdict(criterion) for criterion in criteria],
            "definitions": report.VERDICTS,
            "events": events,
            "files": files,
        }
        print(atomic.dumps(contents))
        return 0
    console = Console(highlight=False)
    shown = ("scenario", "seed", "started", "exit_reason", "hsr8", "python", "machine", "renderer")
    made = {key: manifest.get(key) for key in shown}
    if made["exit_reason"] == RUNNING:
        made["exit_reason"] = "running, or killed; its records can be read"
    others = {name: f"was {then}, is {now}" for name, then, now in other_versions(manifest)}
    console.print(tables.facts(made | others, str(run.folder)))
    if events:
        title = f"the last {MAX_EVENTS} of {len(events)} events"
        rows = [
            {"time_s": event["time"], "kind": event["kind"], "event": event["text"]}
            for event in events[-MAX_EVENTS:]
        ]
        console.print(tables.rows(rows, title if len(events) > MAX_EVENTS else "events"))
    sizes = ", ".join(f"{escaped(name)} {size / 1e3:.1f} kB" for name, size in files.items())
    lines = [f"files       {sizes}"]
    command = str(manifest.get("command", ""))
    if command.isprintable():
        lines.append(f"again       {command}")
    if results:
        show(run, criteria, console, everything=options.all)
        lines += report.lines(run, criteria, run.folder)
    for line in lines:
        console.print(line, soft_wrap=True, markup=False)
    return 0


def _criteria(run: Run) -> tuple[Criterion, ...]:
    """Return the criteria, where there are results and this version can read the scenario."""
    try:
        return run.criteria
    except (UsageError, KeyError):  # made by another version
        return ()


def show(run: Run, criteria: Sequence[Criterion], console: Console, *, everything: bool) -> None:
    """Print the results and criteria of a run as tables.

    Args:
        run: run with results.
        criteria: its criteria, evaluated.
        console: output.
        everything: all results, not the first rows only.
    """
    names = [*PLAIN]
    if everything:
        names += [m.name for m in shown_in(Shown.RUN) if m.name not in PLAIN]
    values = {_head(name): run.metrics.get(name) for name in names}
    console.print(tables.facts(values, "results"))
    if criteria:
        console.print(tables.rows([asdict(criterion) for criterion in criteria], "criteria"))


def _head(name: str) -> str:
    """Return the name of a metric, with the unit that it does not state itself."""
    unit = METRICS[name].unit
    return f"{name} [{unit}]" if "," in unit else name
