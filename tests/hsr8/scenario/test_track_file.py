import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import dump, load_scenario, loads
from hsr8.scenario.track_file import (
    TrackFileError,
    content,
    recorded_tracks,
    track_digests,
)

ROWS = "t,x,y,id\n0.0,-3.0,0.0,a\n0.4,-2.5,0.1,a\n"
number = st.floats(-100.0, 100.0)


@given(
    st.lists(st.tuples(number, number, st.sampled_from(["1", "b.2", "c_3"])), min_size=6),
)
def test_samples_are_those_of_the_rows(rows):
    lines, expected = ["t,x,y,id"], {}
    for x, y, name in rows * 2:
        time = 0.4 * (len(expected.get(name, ())))
        lines.append(f"{time!r},{x!r},{y!r},{name}")
        expected.setdefault(name, []).append((time, (x, y)))
    data = content("\n".join(lines))
    samples = {
        track.id: list(zip(track.times.tolist(), map(tuple, track.points.tolist()), strict=True))
        for track in recorded_tracks(data)
    }
    assert samples == expected
    assert content(data) == data


@pytest.mark.parametrize(
    "text",
    [
        ROWS.replace(",", ";"),
        ROWS.replace(",", "\t"),
        ROWS.replace(",", " ; "),
        ROWS.replace("t,x,y,id", "T,X,Y,ID"),
        ROWS.replace(",", ";").replace(".", ","),
        "\ufeff"
        + ROWS.replace("t,x,y,id", "Id;Y;note;X;T")
        .replace("0.0,-3.0,0.0,a", "a;0,0;1,5 m;-3,0;0,0")
        .replace("0.4,-2.5,0.1,a", 'a;0,1;"a;b";-2,5;0,4'),
    ],
)
def test_separators_decimal_commas_and_case_of_the_header_do_not_matter(text, tmp_path):
    (tmp_path / "crowd.csv").write_text(text)
    scenario = tmp_path / "mine.toml"
    scenario.write_text(
        'extends = "course"\n[[world.mover]]\nmotion = "track"\nfile = "crowd.csv"\n'
        'scale = 0.9\ntime_scale = 4.0\nend = "stay"\n'
    )
    (mover,) = load_scenario(str(scenario)).world.mover
    assert mover.data == ROWS


def test_other_columns_their_order_and_line_ends_do_not_matter():
    text = "\ufeffid, y ,speed,x,t\r\na,0.0,9,-3.0,0.0\r\n\r\na,0.1,,-2.5,0.4\r\n"
    assert content(text.lstrip("\ufeff")) == ROWS


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "line 1: column 't' is missing, got ''; expected a header with t, x, y and id"),
        ("t,x,y\n0,1,2\n", "line 1: column 'id' is missing, got 't,x,y'"),
        (ROWS + "0.8,1.0\n", "line 4: a column is missing, got 2 values"),
        (ROWS + "0.8,nan,0.0,a\n", "line 4: x is not valid, got 'nan'; expected metres"),
        (ROWS + "0.8,0.0,3_0,a\n", "line 4: y is not valid, got '3_0'"),
        (ROWS + "0.8,0.0,0.0,\n", "line 4: id is not valid, got ''; expected 1 to 32 letters"),
        (ROWS + "0.4,0.0,0.0,a\n", "line 4, id a: duplicate sample, got t = 0.4 s twice"),
        (ROWS + "0.2,0.0,0.0,a\n", "line 4, id a: time decreases, got t = 0.2 s after 0.4 s"),
        (ROWS + "2.4,0.0,0.0,a\n", "line 4, id a: gap between samples, got 2 s after t = 0.4 s"),
    ],
)
def test_an_invalid_file_is_refused_with_its_line(text, expected, tmp_path):
    with pytest.raises(TrackFileError) as caught:
        content(text)
    assert expected in str(caught.value)
    (tmp_path / "crowd.csv").write_text(text)
    scenario = tmp_path / "mine.toml"
    scenario.write_text(
        'extends = "course"\n[[world.mover]]\nmotion = "track"\nfile = "crowd.csv"\n'
    )
    with pytest.raises(ScenarioError) as refused:
        load_scenario(str(scenario))
    assert refused.value.exit_code == 2
    (line,) = str(refused.value).splitlines()[1:]
    assert line.startswith(f"  {scenario}:4: world.mover[0].file: crowd.csv, ")


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("none.csv", "none.csv, file does not exist, got 'none.csv'; expected a CSV file next to"),
        (".", "Is a directory"),
        ("image.csv", "wrong encoding, got UTF-16; expected UTF-8"),
    ],
)
def test_an_unreadable_file_is_refused(name, expected, tmp_path):
    (tmp_path / "image.csv").write_bytes(b"\xff\xfe\x00")
    file = tmp_path / "mine.toml"
    file.write_text(f'extends = "course"\n[[world.mover]]\nmotion = "track"\nfile = "{name}"\n')
    with pytest.raises(ScenarioError) as caught:
        load_scenario(str(file))
    assert expected in str(caught.value)


@pytest.fixture
def crowd(tmp_path):
    """Scenario with the recording of `ROWS`."""
    (tmp_path / "crowd.csv").write_text(ROWS)
    file = tmp_path / "mine.toml"
    file.write_text(
        'extends = "course"\n[[world.mover]]\nmotion = "track"\nfile = "crowd.csv"\n'
        'scale = 0.9\ntime_scale = 4.0\nend = "stay"\n'
    )
    return file


def test_a_saved_scenario_needs_no_file(crowd, tmp_path):
    scenario = load_scenario(str(crowd))
    text = dump(scenario)
    (tmp_path / "crowd.csv").unlink()
    assert loads(text) == scenario
    assert dump(loads(text)) == text
    (mover,) = loads(text).world.mover
    assert (mover.file, mover.data) == ("crowd.csv", ROWS)


def test_another_file_replaces_the_content_of_a_saved_scenario(crowd, tmp_path):
    saved, other = tmp_path / "saved.toml", tmp_path / "other.csv"
    saved.write_text(dump(load_scenario(str(crowd))))
    other.write_text(ROWS.replace("-3.0", "-2.9"))
    (mover,) = load_scenario(str(saved), [f"world.mover.0.file={other}"]).world.mover
    assert (mover.file, "-2.9" in mover.data) == ("other.csv", True)
    (mover,) = load_scenario(str(saved), ["world.mover.0.scale=0.8"]).world.mover
    assert (mover.data, mover.scale) == (ROWS, 0.8)


def test_the_digest_is_that_of_the_four_columns(crowd):
    scenario = load_scenario(str(crowd))
    assert track_digests(scenario.world.mover) == {"tracks crowd.csv": "7defe875e4e0"}
