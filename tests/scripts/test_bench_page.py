import sys

import bench_page
import pytest

from hsr8.evaluation.bench.entry import Entry


def entry(name, successes):
    """Entry with one family, of which the first runs succeed."""
    numbers = dict.fromkeys(("collisions", "collisions_moving", "falls"), 0)
    lengths = {"path_length_m": 2.0, "certified_length_m": 1.0}
    times = {"time_to_goal_s": 9.0, "certified_time_s": 6.0}
    more = {"min_clearance_m": 0.1, "head_travel_radps": 0.3, "state_hash": "", "exit_reason": ""}
    runs = [
        {"seed": k, "outcome": "passed", "success": k < successes}
        | {**numbers, **lengths, **times, **more}
        for k in range(4)
    ]
    return Entry(
        name=name,
        suite="hsr8",
        suite_version=1,
        suite_hash="abc",
        seeds="full",
        command=f"hsr8 bench --name {name}",
        settings={},
        versions={"hsr8": "0.1.0"},
        scenarios={"course": "a"},
        runs={"course": runs},
    )


@pytest.fixture
def page(tmp_path, monkeypatch):
    """The script with a page and folders in a temporary folder; returns the page after a call."""
    (tmp_path / "results").mkdir()
    page = tmp_path / "bench.md"
    page.write_text(f"# Head\n\n{bench_page.BEGIN}\nold\n{bench_page.END}\n\n## Tail\n")
    monkeypatch.setattr(bench_page, "ENTRIES", tmp_path / "results")
    monkeypatch.setattr(bench_page, "PAGE", page)

    def write(*arguments):
        monkeypatch.setattr(sys, "argv", ["bench_page.py", *map(str, arguments)])
        bench_page.main()
        return page.read_text()

    return write


def store(folder, made):
    (folder / made.name).mkdir(parents=True)
    (folder / made.name / "bench.json").write_text(made.text())


def test_entries_are_collected_and_ranked(page, tmp_path):
    folder = tmp_path / "bench"
    for made in (entry("weak", 1), entry("default", 2), entry("strong", 4)):
        store(folder, made)
    text = page(folder)
    assert text.startswith("# Head\n")
    assert text.endswith("\n\n## Tail\n")
    assert "old" not in text
    rows = [line.split(" |")[0] for line in text.splitlines() if " of 4 |" in line]
    assert rows == ["| default", "| strong", "| weak"]
    assert "| weak | `hsr8 bench --name weak` |" in text
    assert sorted(file.name for file in (tmp_path / "results").iterdir()) == [
        "default.json",
        "strong.json",
        "weak.json",
    ]
    assert page() == text


def test_without_entries_or_of_two_suites_there_is_no_table(page, tmp_path, capsys):
    with pytest.raises(SystemExit):
        page(tmp_path)
    assert "no entry" in capsys.readouterr().err
    folder = tmp_path / "bench"
    store(folder, entry("default", 2))
    text = entry("new", 2).text().replace('"suite_version": 1', '"suite_version": 2')
    (folder / "new").mkdir()
    (folder / "new" / "bench.json").write_text(text)
    with pytest.raises(SystemExit):
        page(folder)
    assert "new: version of the suite differs, got 2; expected 1" in capsys.readouterr().err


def test_the_page_of_the_project_has_the_markers():
    text = bench_page.PAGE.read_text()
    assert 0 < text.index(bench_page.BEGIN) < text.index(bench_page.END)
