"""Results: their definition is valid, pages follow from their data, and all are of one version."""

import csv
import re
import tomllib
from dataclasses import replace
from itertools import pairwise

import pytest
from benchmark_pages import MARK, MAX_LINES, RESULTS, Page, index, versions, with_included
from benchmark_runs import DEFINITION, Definition
from benchmark_table import COLUMNS, row

from hsr8.scenario.loader import load_scenario

MADE = {"version": "0.1.0", "code": "0123456789ab", "date": "2026-01-01", "machine": "x86_64"}
PLACEHOLDER = re.compile(r"\{[^{}]+\}")


def result(seed, success=True, **more):
    known = {"certified_time_s": 50.0, "time_to_goal_s": 60.0 if success else None, "falls": 0}
    return {"seed": seed, "outcome": "passed", "success": success, "collisions": 0} | known | more


@pytest.fixture(scope="module")
def definition():
    return Definition()


@pytest.fixture
def page_of(definition, tmp_path, monkeypatch):
    """A page whose runs all succeed but those of seed 1000."""

    def page(name, **made):
        def results(cell, root):
            return [result(seed, seed != 1000) for seed in cell.seeds]

        monkeypatch.setattr("benchmark_runs.Cell.results", results)
        page = Page(name, definition, tmp_path)
        page.write_data(definition.page_cells([name]), tmp_path, MADE | made)
        return page

    return page


def test_every_cell_is_a_valid_scenario(definition):
    for cell in {replace(cell, seeds=()) for cell in definition.cells if not cell.unavailable()}:
        load_scenario(cell.scenario, list(cell.settings))


def test_seeds_are_held_out(definition):
    assert all(min(cell.seeds) >= 1000 for cell in definition.cells)


def test_no_arm_is_unused():
    content = tomllib.loads(DEFINITION.read_text())
    used = {arm for page in content["pages"].values() for arm in page["arms"]}
    used |= {arm["like"] for arm in content["arms"].values() if "like" in arm}
    assert used == set(content["arms"])


@pytest.mark.parametrize("name", list(Definition().pages))
def test_a_page_has_an_answer_one_narrow_table_and_its_setup(name, page_of, definition):
    page = page_of(name)
    text = page.text()
    lines = text.splitlines()
    assert text.startswith(MARK)
    assert len(lines) <= MAX_LINES
    assert not PLACEHOLDER.search(text.replace("random={}", ""))
    assert "not measured" not in text
    heads = [line for line, after in pairwise(lines) if re.match(r"\|-", after)]
    assert len(heads) == 1
    assert heads[0].count("|") - 1 <= 7
    for part in ("**Setup.**", "**Caveats.**", "make benchmarks ONLY=", "0123456789ab"):
        assert part in text


def test_the_table_of_a_page_is_also_csv_and_latex(page_of):
    page = page_of("gaze")
    page.write()
    table = page.rows(page.read()[0])
    with page.data.with_suffix(".csv").open(newline="", encoding="utf-8") as file:
        assert list(csv.reader(file)) == table
    latex = page.data.with_suffix(".tex").read_text(encoding="utf-8")
    assert latex.count(r"\\") == len(table)
    assert latex.count(" & ") == len(table) * (len(table[0]) - 1)


def test_the_headline_is_filled(page_of, definition):
    for _, template, name in definition.headline:
        page = page_of(name)
        text = page.filled(template, page.read()[0])
        assert not PLACEHOLDER.search(text)
        assert "not measured" not in text


def test_numbers_of_a_text(definition):
    (cell,) = definition.cells_of("no-fault")
    runs = [row(cell, result(seed, seed % 2 == 0)) for seed in range(10)]
    filled = Page("faults", definition).filled
    assert filled("{no-fault.success}", runs) == "5 of 10 (24–76 %)"
    assert filled("{no-fault/quick.falls}", runs) == "0 of 10"
    assert filled("{no-fault/course.falls}", runs) == "(not measured)"
    assert COLUMNS["spt"][1](runs, runs) == f"{100 * 0.5 * 50 / 60:.0f} %"


def test_an_arm_is_compared_with_its_reference_in_the_same_worlds(definition):
    def runs(arm, successes):
        (cell, _) = definition.cells_of(arm)
        return [row(cell, result(seed, seed < successes)) for seed in range(10)]

    page = Page("gaze", definition)
    all_runs = runs("risk", 9) + runs("ideal-risk", 10) + runs("ideal-steps", 4)
    assert page.filled("{ideal-steps.difference}", all_runs).startswith("-60.0")
    assert page.filled("{ideal-risk.difference}", all_runs).startswith("+10.0")
    risk, ideal, steps = (" ".join(cells) for cells in page.rows(all_runs)[-3:])
    assert ("+10.0" in ideal, "-60.0" in steps, "p " in risk) == (True, True, False)


def test_an_arm_has_the_settings_of_the_arm_that_it_is_like(definition):
    (cell, *_) = definition.cells_of("wide-steps")
    assert cell.settings[0] == "robot.body=kinematic"
    assert cell.settings[-1] == "camera.vertical_fov_deg=70"
    levels = definition.cells_of("pushes")
    assert len({cell.folder(RESULTS) for cell in levels}) == len(levels) == 4


def test_the_index_lists_pages_without_data(definition, page_of):
    measured = page_of("walking")
    pages = [Page("gaze", definition, measured.file.parent), measured]
    text = index(definition, pages)
    assert "| Gaze |" in text
    assert "not measured with this version" in text
    assert "[Walking](walking.md)" in text


def test_numbers_on_other_pages_are_replaced_between_their_markers():
    page = "a\n<!-- benchmark x -->\nold\n<!-- end benchmark x -->\nb"
    new = with_included(page, "x", ["| new |"])
    assert "old" not in new
    assert new.startswith("a\n<!-- benchmark x -->")
    assert new.endswith("b")
    assert with_included(new, "x", ["| new |"]) == new
    assert with_included(page, "y", ["| new |"]) == page


def test_pages_of_two_versions_are_found(definition, page_of):
    page_of("walking")
    page = page_of("faults", code="f" * 12)
    assert len({made["code"] for made in versions(definition, page.file.parent).values()}) == 2


def test_the_pages_in_the_repository_follow_from_their_data_and_have_one_version(definition):
    made = versions(definition)
    assert len({(page["code"], page["date"]) for page in made.values()}) <= 1, made
    for name in made:
        page = Page(name, definition)
        assert page.file.read_text(encoding="utf-8") == page.text(), f"{page.file} was edited"
