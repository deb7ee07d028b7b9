"""Pages of the results, written from their data: one page, one Parquet file, one version each.

The table of a page is next to its data as CSV and as LaTeX, too.
"""

import csv
import io
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hsr8.files import atomic
from hsr8.sweep.comparison_page import tabular

import pyarrow as pa
import pyarrow.parquet as pq
from benchmark_runs import Cell, Definition
from benchmark_table import COLUMNS, Run, row
from measured import read_results

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "docs" / "results"
INCLUDED = ("README.md", "docs/robots.md")
"""Pages outside of the results that show numbers of them, between markers."""
MARK = "<!-- made by `make benchmarks` -->"
MADE = b"benchmark"  # key of the metadata of a data file
MAX_LINES = 80
PLACE = re.compile(r"\{([\w-]+)(?:@([^./}]+(?:\.\d+[^./}]*)?))?(?:/([\w-]+))?\.(\w+)\}")
"""Place of a number in a text: arm, level, scenario and column."""
Table = list[list[str]]
"""Cells of a table; its first row has the heads."""
LEVELS = ("mild: success", "medium: success", "strong: success")  # heads of levels


class Page:
    """One page with its data.

    Args:
        name: name of the page.
        definition: definition of all results.
        results: folder of the pages.
    """

    def __init__(self, name: str, definition: Definition, results: Path = RESULTS) -> None:
        self.name, self.definition = name, definition
        self.table = definition.pages[name]
        self.file = results / f"{name}.md"
        self.data = results / "data" / f"{name}.parquet"

    def write_data(self, cells: Sequence[Cell], root: Path, made: dict[str, str]) -> None:
        """Write the data of the page from the finished runs of its cells.

        Args:
            cells: cells of the page.
            root: folder of the runs.
            made: version, date and machine of the runs.
        """
        rows = [row(cell, result) for cell in cells for result in cell.results(root)]
        table = pa.Table.from_pylist(rows).replace_schema_metadata({MADE: json.dumps(made)})
        self.data.parent.mkdir(parents=True, exist_ok=True)
        pq.write_table(table, self.data, compression="zstd")

    def read(self) -> tuple[list[Run], dict[str, str]] | None:
        """Return the rows of the runs, and version, date and machine; None without data."""
        if not self.data.exists():
            return None
        table = pq.read_table(self.data)
        return table.to_pylist(), json.loads(table.schema.metadata[MADE])

    def text(self) -> str:
        """Return the page; without data it is empty."""
        stored = self.read()
        if stored is None:
            return ""
        runs, made = stored
        page = self.table
        lines = [MARK, "", f"# {page['title']}", "", f"**{page['question']}**", ""]
        lines += [self.filled(page["answer"], runs), "", *_markdown(self.rows(runs)), ""]
        lines += self.measured()
        lines += ["**Setup.** " + page["setup"], ""]
        lines += ["**Caveats.**", "", *(f"- {text}" for text in page["caveats"]), ""]
        data = f"data/{self.name}"
        made_by = (
            f"[Runs]({data}.parquet), table as [CSV]({data}.csv) and [LaTeX]({data}.tex): "
            f"`make benchmarks ONLY={self.name}`."
        )
        lines += [f"Seeds {_seeds(runs)}. {_made(made)} {made_by}", ""]
        if len(lines) > MAX_LINES:
            raise ValueError(f"{self.file}: {len(lines)} lines; expected at most {MAX_LINES}")
        return "\n".join(lines)

    def write(self) -> None:
        """Write the page, and its table as CSV and LaTeX; nothing without data."""
        stored = self.read()
        if stored is None:
            return
        atomic.write_text(self.file, self.text())
        head, *rows = self.rows(stored[0])
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([head, *rows])
        atomic.write_text(self.data.with_suffix(".csv"), text.getvalue())
        latex = tabular(head, rows, "l" + "r" * (len(head) - 1))
        note = f"% {self.table['title']}. {_made(stored[1])}\n"
        atomic.write_text(self.data.with_suffix(".tex"), note + latex)

    def rows(self, runs: Sequence[Run]) -> Table:
        """Return the table of the page."""
        page = self.table
        groups = _groups(runs, page["rows"], page["arms"])
        if page["rows"] == "levels":
            return _levels(groups)
        scenarios = list(dict.fromkeys(run["scenario"] for run in runs))
        by_scenario = scenarios if page.get("by_scenario") else []
        heads = [*(f"`{s}`" for s in by_scenario), *(COLUMNS[c][0] for c in page["columns"])]
        table = [["", *heads]]
        for label, group in groups.items():
            cells = [_counted([r for r in group if r["scenario"] == s]) for s in by_scenario]
            arm = group[0]["arm"]
            reference = self._reference(arm, runs) if self._compared_with(arm) != arm else group
            cells += [COLUMNS[column][1](group, reference) for column in page["columns"]]
            shown = page.get("labels", {}).get(label, label)
            table.append([shown, *cells])
        return table

    def measured(self) -> list[str]:
        """Return the table of the CSV file of a separate study, if the page names one.

        One row per study and level, one column per robot and walker.
        """
        page = self.table
        file = self.data.parent / page.get("measured", "")
        if not file.is_file():
            return []
        cells = {
            ((c["study"], c["level"]), (c["robot"], c["walker"])): c for c in read_results(file)
        }
        walkers = list(dict.fromkeys(walker for _, walker in cells))
        table = [["", *(", ".join(walker) for walker in walkers)]]
        for level in dict.fromkeys(level for level, _ in cells):
            results = [cells[level, w]["result"] if (level, w) in cells else "" for w in walkers]
            table.append([" = ".join(level), *results])
        codes = ", ".join(dict.fromkeys(cell["code"] for cell in cells.values()))
        return [
            page["measured_text"],
            "",
            *_markdown(table),
            "",
            f"Code {codes}. {page['measured_by']}",
            "",
        ]

    def filled(self, text: str, runs: Sequence[Run]) -> str:
        """Return a text with its ``{ARM.COLUMN}``, with ``@LEVEL`` or ``/SCENARIO`` after the arm.

        Args:
            text: the text.
            runs: runs of the page.
        """

        def cell(match: re.Match[str]) -> str:
            arm, level, scenario, column = match.groups()
            chosen = [
                run
                for run in runs
                if run["arm"] == arm
                and (scenario is None or run["scenario"] == scenario)
                and (level is None or run["level"] == level)
            ]
            if not chosen:
                return "(not measured)"
            return COLUMNS[column][1](chosen, self._reference(arm, runs))

        return PLACE.sub(cell, text)

    def _compared_with(self, arm: str) -> str:
        """Return the arm that an arm is compared with in the same worlds."""
        reference: str = self.table.get("reference", arm)
        references: dict[str, str] = self.table.get("references", {})
        return references.get(arm, reference)

    def _reference(self, arm: str, runs: Sequence[Run]) -> list[Run]:
        """Return the runs that those of an arm are compared with."""
        return [run for run in runs if run["arm"] == self._compared_with(arm)]


def _groups(runs: Sequence[Run], kind: str, arms: Sequence[str]) -> dict[str, list[Run]]:
    """Return the runs of each row of a table by its label."""
    groups: dict[str, list[Run]] = {}
    for arm in arms:
        of_arm = [run for run in runs if run["arm"] == arm]
        scenarios = dict.fromkeys(run["scenario"] for run in of_arm)
        for run in of_arm:
            label = f"{arm}, {run['level']}" if run["level"] else arm
            if kind == "scenarios":
                label = (
                    f"`{run['scenario']}`" if len(scenarios) > 1 else f"{arm}, `{run['scenario']}`"
                )
            groups.setdefault(label, []).append(run)
    return groups


def _levels(groups: dict[str, list[Run]]) -> Table:
    """Return the table of arms with levels: one row per arm."""
    by_arm: dict[str, list[str]] = {}
    for group in groups.values():
        level = group[0]["level"]
        text = _counted(group)
        by_arm.setdefault(group[0]["arm"], []).append(f"{level}: {text}" if level else text)
    width = max(map(len, by_arm.values()), default=0)
    rows = [[arm, *cells, *[""] * (width - len(cells))] for arm, cells in by_arm.items()]
    return [["fault", *LEVELS[:width]], *rows]


def _markdown(table: Table) -> list[str]:
    """Return a table in Markdown."""
    head, *rows = (f"| {' | '.join(cells)} |" for cells in table)
    return [head, "|" + "---|" * len(table[0]), *rows]


def _counted(runs: Sequence[Run]) -> str:
    return f"{sum(run['success'] for run in runs)} of {len(runs)}" if runs else ""


def _seeds(runs: Sequence[Run]) -> str:
    seeds = [run["seed"] for run in runs]
    return f"{min(seeds)} to {max(seeds)}" if seeds else "none"


def _made(made: dict[str, str]) -> str:
    return f"Version {made['version']}, code {made['code']}, {made['date']}."


def index(definition: Definition, pages: Sequence[Page]) -> str:
    """Return the index of the results.

    Args:
        definition: definition of all results.
        pages: all pages.
    """
    stored = {page.name: page.read() for page in pages}
    lines = [MARK, "", "# Results", ""]
    table = [["page", "answer"]]
    for page in pages:
        data = stored[page.name]
        answer = (
            page.filled(page.table["answer"], data[0]) if data else "not measured with this version"
        )
        link = f"[{page.table['title']}]({page.name}.md)" if data else page.table["title"]
        table.append([link, answer])
    lines += [definition.index["text"].strip(), "", *_markdown(table)]
    made = [data[1] for data in stored.values() if data]
    if made:
        lines += ["", f"{_made(made[0])} {made[0]['machine']}."]
    return "\n".join([*lines, ""])


def headline(definition: Definition, pages: Sequence[Page]) -> list[str]:
    """Return the table of the README and its version: rows whose pages have data; empty without."""
    by_name = {page.name: page for page in pages}
    table, made = [["measured", "result", "page"]], []
    for label, text, name in definition.headline:
        if stored := by_name[name].read():
            link = f"[{name}](docs/results/{name}.md)"
            table.append([label, by_name[name].filled(text, stored[0]), link])
            made.append(_made(stored[1]))
    return [*_markdown(table), "", made[0]] if made else []


def with_included(text: str, name: str, table: Sequence[str]) -> str:
    """Return a page with the table between its markers for `name`, if it has them."""
    begin, end = f"<!-- benchmark {name} -->", f"<!-- end benchmark {name} -->"
    if begin not in text:
        return text
    before, _, rest = text.partition(begin)
    _, _, after = rest.partition(end)
    return "\n".join([before + begin, "", *table, "", end + after])


def write(definition: Definition, results: Path = RESULTS) -> None:
    """Write all pages that have data, the index, and the numbers that other pages include."""
    pages = [Page(name, definition, results) for name in definition.pages]
    for page in pages:
        page.write()
    atomic.write_text(results / "README.md", index(definition, pages))
    for name in INCLUDED if results == RESULTS else ():
        text = (ROOT / name).read_text(encoding="utf-8")
        if table := headline(definition, pages):
            text = with_included(text, "headline", table)
        for page in pages:
            if stored := page.read():
                text = with_included(text, page.name, _markdown(page.rows(stored[0])))
        atomic.write_text(ROOT / name, text)


def versions(definition: Definition, results: Path = RESULTS) -> dict[str, dict[str, Any]]:
    """Return version, date and machine of every page that has data."""
    pages = [Page(name, definition, results) for name in definition.pages]
    return {page.name: stored[1] for page in pages if (stored := page.read())}
