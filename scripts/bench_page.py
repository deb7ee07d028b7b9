"""Collect entries of ``hsr8 bench`` and write their table into ``docs/results/bench/README.md``.

    python scripts/bench_page.py bench

Every ``bench/NAME/bench.json`` is copied to ``docs/results/bench/NAME.json``; the table is that of
all files there. The entry called ``default`` is the first line and the reference of the
differences; the others follow by success and SPL. Without a folder the table is written again.
"""

import argparse
import shutil
from collections.abc import Sequence
from pathlib import Path

from hsr8.errors import Hsr8Error
from hsr8.evaluation.bench.entry import ALL, FILE, Entry, read_entry
from hsr8.evaluation.bench.page import entries_table
from hsr8.files import atomic

from study_page import RESULTS

ENTRIES = RESULTS / "bench"
PAGE = ENTRIES / "README.md"
BEGIN = "<!-- written by scripts/bench_page.py -->"
END = "<!-- end -->"
FIRST = "default"


def ranked(entries: Sequence[Entry]) -> list[Entry]:
    """Return the entries in the order of the table."""

    def rank(entry: Entry) -> tuple[bool, float, float, str]:
        score = entry.scores()[ALL]
        return (entry.name != FIRST, -score.success.fraction, -(score.spl or 0.0), entry.name)

    return sorted(entries, key=rank)


def filled(page: str, entries: Sequence[Entry]) -> str:
    """Return the page with the table of the entries between its markers.

    Raises:
        UsageError: the entries are not comparable.
    """
    before, _, rest = page.partition(BEGIN)
    _, _, after = rest.partition(END)
    table = "\n".join(entries_table(ranked(entries)))
    return f"{before}{BEGIN}\n\n{table}\n\n{END}{after}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?", help="folder of the entries, bench")
    folder = parser.parse_args().folder
    for file in folder.glob(f"*/{FILE}") if folder else ():
        shutil.copyfile(file, ENTRIES / f"{file.parent.name}.json")
    try:
        entries = [read_entry(file) for file in sorted(ENTRIES.glob("*.json"))]
        if not entries:
            parser.error(f"{ENTRIES}: no entry")
        page = filled(PAGE.read_text(encoding="utf-8"), entries)
    except Hsr8Error as error:
        parser.error(str(error))
    atomic.write_text(PAGE, page)


if __name__ == "__main__":
    main()
