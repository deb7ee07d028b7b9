"""``hsr8 diff``: where two runs part."""

from dataclasses import asdict
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from hsr8.cli.options import Diff
from hsr8.evaluation import run_difference
from hsr8.evaluation.run_difference import RunDifference
from hsr8.recorder.files import atomic
from hsr8.recorder.run.run_reader import Run, open_run

DIFFERENT = 1
LONGEST = 24  # characters of a value that are shown
SHOWN = 12  # results in a terminal; all of them with --json


def main(options: Diff) -> int:
    """Compare two run folders.

    Returns:
        0 where every bit of what happened is the same, else 1.

    Raises:
        UsageError: there is no such run, or its records cannot be read.
    """
    a, b = open_run(options.a), open_run(options.b)
    parts = run_difference.motion(a, b)
    about = [*run_difference.settings(a, b), *run_difference.results(a, b)]
    if options.json:
        told = {
            "a": str(a.path),
            "b": str(b.path),
            "equal": not parts,
            "first": asdict(parts[0]) if parts else None,
            "differences": [asdict(d) for d in (*parts, *about)],
        }
        print(atomic.dumps(told))
    else:
        _show(a, b, parts, about)
    return DIFFERENT if parts else 0


def first_difference(a: Run, b: Run) -> str:
    """Where two runs part, in a sentence; empty where they do not."""
    parts = run_difference.motion(a, b)
    if not parts:
        return ""
    d = parts[0]
    return f"tick {d.tick} ({d.time:.3f} s), {d.channel}: {_said(d.a)} and {_said(d.b)}"


def _show(a: Run, b: Run, parts: list[RunDifference], about: list[RunDifference]) -> None:
    console = Console(highlight=False)
    console.print(f"A           {a.path}\nB           {b.path}", markup=False, soft_wrap=True)
    if parts:
        console.print(f"they part   at {first_difference(a, b)}", markup=False, soft_wrap=True)
    else:
        told = ", ".join(run_difference.RECORDS)
        console.print(f"they part   nowhere: equal, bit for bit ({told})", soft_wrap=True)
    if not (parts or about):
        return
    table = Table("record", escape("first at [s]"))
    table.add_column("what", overflow="fold")
    table.add_column("A")
    table.add_column("B")
    for d in (*parts, *about)[: len(parts) + SHOWN]:
        time = "" if d.time is None else f"{d.time:.3f}"
        table.add_row(d.record, time, escape(d.channel), _said(d.a), _said(d.b))
    console.print(table)
    if len(about) > SHOWN:
        console.print(f"and {len(about) - SHOWN} more settings and results, see --json")


def _said(value: Any) -> str:
    if value is None:
        return "none"
    text = repr(value) if isinstance(value, float) else str(value)
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
