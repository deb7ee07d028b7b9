"""``hsr8 diff``: first difference of two runs."""

from dataclasses import asdict
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from hsr8.cli.options import Diff
from hsr8.errors import escaped
from hsr8.files import atomic
from hsr8.recording import difference
from hsr8.recording.difference import RunDifference
from hsr8.recording.rows import TABLES
from hsr8.recording.run import Run, open_run

DIFFERENT = 1
MAX_VALUE_LENGTH = 24  # in the table [characters]
MAX_ROWS = 12  # settings and results in the table; --json has all of them


def main(options: Diff) -> int:
    """Compare two run folders.

    Returns:
        0 where every bit of the recorded motion is equal, else 1.
    """
    a, b = open_run(options.a), open_run(options.b)
    motion = difference.first_differences(a, b)
    about = [*difference.settings(a, b), *difference.results(a, b)]
    if options.json:
        comparison = {
            "a": str(a.folder),
            "b": str(b.folder),
            "equal": not motion,
            "first": asdict(motion[0]) if motion else None,
            "differences": [asdict(d) for d in (*motion, *about)],
        }
        print(atomic.dumps(comparison))
    else:
        _show(a, b, motion, about)
    return DIFFERENT if motion else 0


def _show(a: Run, b: Run, motion: list[RunDifference], about: list[RunDifference]) -> None:
    console = Console(highlight=False, soft_wrap=True)
    for name, run in (("A", a), ("B", b)):
        console.print(f"{name}           {escaped(str(run.folder))}", markup=False)
    if motion:
        d = motion[0]
        values = f"{_text(d.a)} and {_text(d.b)}"
        where = f"at tick {d.tick} ({d.time:.3f} s), {escaped(d.channel)}: {values}"
        console.print(f"differ      {where}", markup=False)
    else:
        console.print(f"equal       bit for bit ({', '.join(TABLES)})")
    if not (motion or about):
        return
    table = Table("record", escape("first at [s]"))
    table.add_column("channel", overflow="fold")
    table.add_column("A")
    table.add_column("B")
    for d in (*motion, *about)[: len(motion) + MAX_ROWS]:
        time = "" if d.time is None else f"{d.time:.3f}"
        table.add_row(d.record, time, *map(escape, (escaped(d.channel), _text(d.a), _text(d.b))))
    console.print(table, soft_wrap=False)
    if len(about) > MAX_ROWS:
        console.print(f"and {len(about) - MAX_ROWS} more settings and results, see --json")


def _text(value: Any) -> str:
    if value is None:
        return "none"
    text = repr(value) if isinstance(value, float) else escaped(str(value))
    return text if len(text) <= MAX_VALUE_LENGTH else text[: MAX_VALUE_LENGTH - 1] + "…"
