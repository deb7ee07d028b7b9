import json
import re
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.errors import UsageError
from hsr8.sweep.bench.entry import REFERENCE, Entry, entry_page, read_entry

OUTCOMES = st.lists(
    st.sampled_from(["success", "timeout", "collision", "fall", "crashed", "refused"])
)


@settings(max_examples=25)
@given(
    course=OUTCOMES,
    crowd=OUTCOMES,
    name=st.text(),
    settings=st.dictionaries(st.text(), st.tuples(st.text(), st.text()), max_size=3),
)
def test_the_file_holds_the_whole_entry(make_entry, course, crowd, name, settings):
    entry = make_entry(name, course, crowd, settings=settings)
    assert Entry.from_json(json.loads(entry.text())) == entry
    assert json.loads(entry.text()) == json.loads(json.dumps(entry.to_json()))


def test_an_entry_is_read_from_its_folder_or_its_file(make_entry, tmp_path):
    (tmp_path / "bench.json").write_text(make_entry().text())
    assert read_entry(tmp_path) == read_entry(tmp_path / "bench.json") == make_entry()


def test_an_unfinished_entry_is_refused_with_the_next_step(tmp_path):
    (tmp_path / "course").mkdir()
    (tmp_path / "course" / "sweep.json").write_text("{}")
    with pytest.raises(UsageError, match=r"not finished, got results of course; continue it with"):
        read_entry(tmp_path)


def test_all_is_the_score_of_all_families(make_entry):
    scores = make_entry(course=("success", "timeout"), crowd=("collision",)).scores()
    assert list(scores) == ["course", "crowd", "all"]
    assert [part.runs for part in scores.values()] == [2, 1, 3]
    assert scores["all"].success.count == 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda value: value.pop("versions"), "versions: missing"),
        (lambda value: value["runs"]["course"][0].update(outcome="good"), "outcome: wrong value"),
    ],
)
def test_the_key_of_a_mistake_is_named(make_entry, tmp_path, change, message):
    value = json.loads(make_entry().text())
    change(value)
    file = tmp_path / "bench.json"
    file.write_text(json.dumps(value))
    with pytest.raises(UsageError, match=f"{file}: not an entry of hsr8 bench: {message}"):
        read_entry(file)


def row_of(name, lines):
    """Cells of the line of a table that begins with `name`."""
    (line,) = [line for line in lines if line.startswith(f"| {name} ")]
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip("| "))]


def test_the_page_of_an_entry_has_a_line_per_family(make_entry):
    lines = entry_page(make_entry(course=("success", "timeout"))).splitlines()
    cells = row_of("course", lines)
    assert cells[:3] == ["course", "2", "50.0 %"]
    assert cells[4:] == ["0.0", "50.0", "0.0", "0.400", "0.375", "0.200", "0.50", "80.0"]
    assert row_of("all", lines)[1] == "6"
    assert "All settings are those of the standard." in lines
    assert "    hsr8 bench --quick --name default" in lines


def test_the_default_is_shown_on_the_same_worlds():
    default = read_entry(REFERENCE)
    few = {family: [runs[0], runs[2]] for family, runs in default.runs.items()}
    lines = entry_page(replace(default, runs=few)).splitlines()
    for name in (*few, "all"):
        assert row_of(f"{name}, default", lines)[1:] == row_of(name, lines)[1:]
    family, (run, *_) = next(iter(few.items()))
    for other in ({"seed": 5}, {"certified_time_s": 1.0}):
        changed = few | {family: [run | other]}
        lines = entry_page(replace(default, runs=changed)).splitlines()
        assert not [line for line in lines if line.startswith((f"| {family}, d", "| all, d"))]
    assert ", default |" not in entry_page(replace(default, suite="mine"))
