"""Scenario files: defaults, inheritance, mistakes with their lines, and files of any kind."""

import contextlib
import re
from pathlib import Path
from tempfile import mkdtemp
from unicodedata import normalize

import pytest
import tomlkit
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.errors import ScenarioError
from hsr8.mistakes import MAX_LISTED
from hsr8.scenario.layers import built_in_names
from hsr8.scenario.loader import dump, load_scenario, loads

COURSE = 'mission = {kind = "course"}\n'


def mistakes(text):
    """Lines of the error message, one per mistake."""
    with pytest.raises(ScenarioError) as caught:
        loads(text, "file.toml")
    return str(caught.value).splitlines()[1:]


@pytest.mark.parametrize("name", built_in_names())
def test_built_in_scenarios_are_valid_and_equal_after_dump_and_loads(name):
    scenario = load_scenario(name)
    assert scenario.name == name
    assert scenario.description
    assert loads(dump(scenario)) == scenario


def test_every_mistake_is_reported_with_line_key_value_and_allowed_values():
    text = """\
duration = -1
mission = {kind = "course"}
[world]
n_statics = 3
radius = [0.1, -0.2]
[camera]
period_ms = 33
source = "egll"
[navigation.gaze]
mode = "integrate"
"""
    lines = mistakes(text)
    assert len(lines) == 6
    report = "\n".join(lines)
    for pattern in (
        r"file\.toml:1: duration: wrong value, got -1; expected more than 0 and at most 7200 s",
        r"file\.toml:4: world\.n_statics: unknown key; did you mean 'n_static'\?; expected ",
        r"file\.toml:5: world\.radius\[1\]: wrong value, got -0\.2; expected more than 0",
        r"file\.toml:7: camera\.period_ms: wrong value, got 33; expected .* a multiple of 5 ms",
        r'file\.toml:8: camera\.source: wrong value, got "egll"; expected "rendered", "analytic", '
        '"neck-reach" or "omnidirectional"',
        r"file\.toml:10: navigation\.gaze\.mode: wrong value, .*; did you mean 'integrated'\?",
    ):
        assert re.search(pattern, report), pattern


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            COURSE + "[world]\nn_static = 1.5",
            "n_static: wrong value, got 1.5; expected a whole number",
        ),
        (COURSE + "duration = nan", "duration: wrong value, got nan; expected a finite number"),
        (COURSE + "world = 3", "world: wrong value, got 3; expected a table"),
        (COURSE + "[vision]\nwidth = 1", "vision.width: unknown key"),
        (COURSE + "wold.size = [3, 3]", "file.toml:2: wold: unknown key"),
        (COURSE + "[world]\nradius = [0.1, 0.05]", "the first bound must not be above the second"),
        ("", "mission: missing; expected a value: Via points and goal"),
        ('mission = {kind = "tours"}', "did you mean 'tour'?"),
    ],
)
def test_one_mistake(text, expected):
    (line,) = mistakes(text)
    assert expected in line
    assert line.startswith("  file.toml:") or text == ""


def test_unknown_names_missing_files_and_folders_are_refused(tmp_path):
    with pytest.raises(ScenarioError, match="did you mean 'course'"):
        load_scenario("cours")
    with pytest.raises(ScenarioError, match=r"does not exist$"):
        load_scenario(str(tmp_path / "no.toml"))
    with pytest.raises(ScenarioError, match="Is a directory"):
        load_scenario(str(tmp_path))


@pytest.mark.parametrize(
    ("raw", "expected"),
    [
        (b"a = 1\nb = = 2\n", "invalid TOML.*line 2"),
        (b"\xff\xfe", "wrong encoding, got UTF-16; expected UTF-8"),
        (b"a = " + b"[" * 100_000, "nested too deeply"),
    ],
)
def test_files_that_are_not_a_scenario(tmp_path, raw, expected):
    file = tmp_path / "bad.toml"
    file.write_bytes(raw)
    with pytest.raises(ScenarioError, match=expected):
        load_scenario(str(file))


def test_a_file_extends_a_built_in_scenario(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('extends = "course"\n[world]\nn_static = 5\n')
    mine, course = load_scenario(str(file)), load_scenario("course")
    assert mine.name == "mine"
    assert mine.world.n_static == 5
    assert mine.world.n_moving == course.world.n_moving
    assert mine.mission == course.mission


def test_a_file_extends_a_neighbour_but_nothing_elsewhere(tmp_path):
    (tmp_path / "base.toml").write_text('extends = "course"\nduration = 99.0\n')
    (tmp_path / "mine.toml").write_text('extends = "base.toml"\n')
    assert load_scenario(str(tmp_path / "mine.toml")).duration == 99.0
    (tmp_path / "mine.toml").write_text('extends = "../base.toml"\n')
    with pytest.raises(ScenarioError, match=r"mine\.toml:1: extends: unknown scenario"):
        load_scenario(str(tmp_path / "mine.toml"))


def test_scenarios_that_extend_each_other_are_an_error(tmp_path):
    (tmp_path / "a.toml").write_text('extends = "b.toml"\n')
    (tmp_path / "b.toml").write_text('extends = "a.toml"\n')
    with pytest.raises(ScenarioError, match="loop"):
        load_scenario(str(tmp_path / "a.toml"))


def test_mistakes_in_the_parent_are_reported_there(tmp_path):
    (tmp_path / "base.toml").write_text('extends = "course"\nduration = -1.0\n')
    (tmp_path / "mine.toml").write_text('extends = "base.toml"\n[camera]\nperiod_ms = 7\n')
    with pytest.raises(ScenarioError) as caught:
        load_scenario(str(tmp_path / "mine.toml"))
    assert "base.toml:2: duration" in str(caught.value)
    assert "mine.toml:3: camera.period_ms" in str(caught.value)


def test_another_kind_of_mission_drops_the_old_keys(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('extends = "paper"\n[mission]\nkind = "points"\npoints = [[1.0, 1.0]]\n')
    assert load_scenario(str(file)).mission.points == ((1.0, 1.0),)


@settings(max_examples=15)
@given(
    st.floats(0.001, 7200.0),
    st.floats(0.0, 0.01),
    st.integers(0, 2**63 - 1),
    st.text(max_size=40),
)
def test_numbers_and_text_are_equal_after_dump_and_loads(duration, encoder, seed, description):
    scenario = load_scenario("course").model_copy(
        update={"duration": duration, "seed": seed, "description": description}
    )
    scenario = scenario.model_copy(update={"sensors": type(scenario.sensors)(encoder=encoder)})
    assert loads(dump(scenario)) == scenario


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("my room.toml", "my-room"),
        ("ä.toml", "ä"),
        ("a\u0308.toml", "ä"),
        ("!.toml", "scenario-bb7208bc"),
    ],
)
def test_a_file_of_any_name_is_a_scenario(tmp_path, file, name):
    (tmp_path / file).write_text(COURSE)
    assert load_scenario(str(tmp_path / file)).name == name
    (tmp_path / file).write_text(f'name = "own"\n{COURSE}')
    assert load_scenario(str(tmp_path / file)).name == "own"


@pytest.mark.parametrize(
    "rows",
    [
        [f"key{k} = {k}" for k in range(5000)],
        ["text = '''", *["x"] * 2_000, "'''", *(f"key{k} = {k}" for k in range(100))],
    ],
)
def test_the_list_of_mistakes_ends(tmp_path, rows):
    file = tmp_path / "many.toml"
    file.write_text("\n".join(['extends = "course"', *rows]))
    with pytest.raises(ScenarioError) as error:
        load_scenario(str(file))
    title, *lines = str(error.value).splitlines()
    assert title == f"the first {MAX_LISTED} mistakes in scenario {str(file)!r}"
    assert len(lines) == MAX_LISTED
    places = [int(line.split(":")[1]) for line in lines]
    assert places == sorted(set(places))


@settings(max_examples=15)
@given(
    names=st.lists(
        st.text(st.characters(categories=["L", "N"]), min_size=1, max_size=20), min_size=2
    )
)
def test_different_names_in_any_script_stay_different(names):
    stems = {normalize("NFC", name) for name in names}
    folder = Path(mkdtemp())
    for stem in stems:
        (folder / f"{stem}.toml").write_text(COURSE)
    scenarios = [load_scenario(str(folder / f"{stem}.toml")) for stem in stems]
    assert {scenario.name for scenario in scenarios} == stems
    assert loads(dump(scenarios[0])) == scenarios[0]


hidden = st.sampled_from(["\x1b[31m", "\x07", "\x9b", "\u202e", "\u2028", "\x7f", "\r", "\b"])


@given(text=st.lists(hidden | st.text(max_size=3), max_size=4).map("".join), data=st.data())
def test_messages_have_printable_characters_alone(text, data):
    table = data.draw(
        st.sampled_from(
            [
                {text: 1},
                {"name": text},
                {"camera": {"source": text}},
                {"camera": {text: {"x": 1}}},
                {"robot": {"model": text}},
                {"mission": {"kind": text}},
                {"vision": {"split": {text: text}}},
                {"vision": {"color_table": text}},
                {"plugin": {"planner": text}},
                {"extends": text},
                {"world": {"mover": [{"motion": "track", "file": text}]}},
            ]
        )
    )
    for read in (
        lambda: loads(tomlkit.dumps({"mission": {"kind": "course"}} | table), text or "x"),
        lambda: load_scenario("quick", [text]),
        lambda: load_scenario(text),
    ):
        with contextlib.suppress(UnicodeEncodeError):
            message = ""
            try:
                read()
            except ScenarioError as error:
                message = str(error)
            assert all(line.isprintable() for line in message.split("\n"))
            assert message.count("\n") <= 3
