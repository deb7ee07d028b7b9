"""Make the results: run what is missing and write the pages of docs/results.

    python scripts/benchmarks.py
    python scripts/benchmarks.py --only gaze planners
    python scripts/benchmarks.py --runs 1 --out runs/trial
    python scripts/benchmarks.py --status

Ctrl-C stops it; the same command continues. The runs lie in ``benchmarks/CODE``, where CODE is the
digest of the packages, so that changed code begins with no runs and a page never mixes versions.
"""

import argparse
import datetime
import platform
import sys
from collections.abc import Sequence
from pathlib import Path

from hsr8.recording.manifest import code_digest
from hsr8.version import VERSION

from benchmark_pages import RESULTS, ROOT, Page, versions, write
from benchmark_runs import Cell, Definition, workers

RUNS = ROOT / "benchmarks"


def status(definition: Definition, pages: Sequence[str], root: Path, results: Path) -> list[str]:
    """Return one line per page: missing runs, time left, and the version of the page.

    Args:
        definition: definition of all results.
        pages: names of the pages.
        root: folder of the runs of the present code.
        results: folder of the pages.
    """
    code, made = code_digest(), versions(definition, results)
    lines, listed = [], set()
    for name in pages:
        cells = [cell for cell in definition.page_cells([name]) if cell not in listed]
        listed.update(cells)
        missing = sum(cell.missing(root) for cell in cells if not cell.unavailable())
        version = made.get(name, {}).get("code")
        state = "not measured" if version is None else "current" if version == code else "old"
        if state == "old":
            state += f" (code {version})"
        lines.append(f"{name:12} {missing:5} runs missing, {_time_left(cells, root)}; page {state}")
    return lines


def _time_left(cells: Sequence[Cell], root: Path) -> str:
    seconds = sum(
        cell.remaining(root) / (cell.workers or workers())
        for cell in cells
        if not cell.unavailable()
    )
    return f"about {seconds / 60:.0f} min" if seconds < 5400 else f"about {seconds / 3600:.1f} h"


def make(definition: Definition, pages: Sequence[str], root: Path, results: Path) -> None:
    """Run the cells of pages, and write each page when its runs are complete; see `status`."""
    made = {
        "version": VERSION,
        "code": code_digest(),
        "date": datetime.datetime.now(tz=datetime.UTC).date().isoformat(),
        "machine": f"{platform.machine()}, {workers()} cores, Python {platform.python_version()}",
    }
    done: set[Cell] = set()
    for name in pages:
        cells = definition.page_cells([name])
        for cell in cells:
            if cell in done:
                continue
            done.add(cell)
            if robot := cell.unavailable():
                print(f"{cell.arm}: left out, the model of {robot} is not installed")
            elif cell.missing(root):
                label = f"{cell.arm} {cell.level}".strip()
                print(f"{name}: {label}, {cell.scenario}, {cell.missing(root)} runs", flush=True)
                cell.run(root)
        if present := [cell for cell in cells if not cell.unavailable()]:
            Page(name, definition, results).write_data(present, root, made)
            print(f"{name}: complete", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", metavar="PAGE", help="pages to make; default: all")
    parser.add_argument("--runs", type=int, metavar="N", help="at most N runs per sweep, to try")
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="folder of pages; default: docs/results"
    )
    parser.add_argument("--status", action="store_true", help="only show what is missing")
    options = parser.parse_args()
    definition = Definition(runs=options.runs)
    pages = options.only or list(definition.pages)
    for name in pages:
        if name not in definition.pages:
            parser.error(f"--only: got {name}; expected {', '.join(definition.pages)}")
    if options.runs is not None and options.out is None:
        parser.error("--runs: needs --out, because a trial must not replace the pages")
    results = options.out or RESULTS
    root = (options.out / "runs" if options.out else RUNS) / code_digest()
    print("\n".join(status(definition, pages, root, results)), flush=True)
    if options.status:
        return
    cells = definition.page_cells(pages)
    print(f"in all {_time_left(cells, root)} on {workers()} cores; Ctrl-C stops", flush=True)
    try:
        make(definition, pages, root, results)
    except KeyboardInterrupt:
        sys.exit("stopped; the same command continues")
    write(definition, results)
    codes = {page["code"] for page in versions(definition, results).values()}
    if len(codes) > 1:
        print("!! the pages are of different versions: make benchmarks without ONLY")


if __name__ == "__main__":
    main()
