"""Table of the results of a run."""

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rich.console import Console

from hsr8.cli import tables
from hsr8.evaluation.registry import METRICS, Shown, shown_in
from hsr8.recorder.run.verdict import Criterion, exit_code

VERDICTS = {  # definitions
    "success": METRICS["success"].text,
    "criteria_met": "ended by itself and met all [criteria] of the scenario: exit code 0",
}


def show(
    title: str,
    *,
    results: Mapping[str, Any],
    criteria: Sequence[Criterion],
    path: Path,
    command: str,
    console: Console | None = None,
) -> None:
    """Print results and criteria of a run, and the commands that continue with it."""
    console = console or Console()
    console.print(
        tables.facts(
            {metric.name: results.get(metric.name) for metric in shown_in(Shown.RUN)}, title
        )
    )
    if results:
        met = exit_code(str(results.get("exit_reason")), criteria) == 0
        verdicts = {"success": results.get("success"), "criteria_met": met}
        for name, verdict in verdicts.items():
            text = f"{name:<14}{'yes' if verdict else 'no'} ({VERDICTS[name]})"
            console.print(text, highlight=False, soft_wrap=True, markup=False)
    if criteria:
        console.print(tables.rows([asdict(criterion) for criterion in criteria]))
    word = shlex.quote(str(path))
    lines = (
        f"run folder  {path}",
        f"log         hsr8 replay {word}",
        f"video       hsr8 render {word}",
        f"plots       hsr8 plot {word}",
        f"again       {command}",
    )
    for line in lines:
        console.print(line, highlight=False, soft_wrap=True, markup=False)
