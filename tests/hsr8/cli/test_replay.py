import pytest
from rerun.chunk import RrdReader

from hsr8.cli.main import entry
from hsr8.recording import run_folder


@pytest.fixture
def run(quick_run):
    return quick_run.path


def test_without_a_display_alternatives_are_printed(run, capsys, monkeypatch):
    (run / run_folder.LOG).touch()
    monkeypatch.setattr("hsr8.show.viewer.has_display", lambda: False)
    assert entry(["replay", str(run)]) == 2
    printed = capsys.readouterr().err
    assert "--screenshot" in printed
    assert "rerun-sdk==" in printed


def test_the_screenshot_shows_the_middle_of_the_run_by_default(run, monkeypatch, capsys):
    asked = []

    def screenshot(log, time, size):
        asked.append((log, time, size))
        return b"PNG"

    (run / run_folder.LOG).touch()
    monkeypatch.setattr("hsr8.show.viewer.screenshot", screenshot)
    picture = run / "log.png"
    assert entry(["replay", str(run), "--screenshot", str(picture)]) == 0
    assert entry(["replay", str(run), "--screenshot", str(picture), "--time", "0.1"]) == 0
    assert picture.read_bytes() == b"PNG"
    assert asked[0] == (run / run_folder.LOG, 0.5, (1600, 900))
    assert asked[1][1] == 0.1


def test_a_missing_log_is_made_from_the_tables(run, monkeypatch, capsys):
    monkeypatch.setattr("hsr8.show.viewer.screenshot", lambda *_: b"PNG")
    assert not (run / run_folder.LOG).exists()
    assert entry(["replay", str(run), "--screenshot", str(run / "log.png")]) == 0
    entities = {str(chunk.entity_path) for chunk in RrdReader(str(run / run_folder.LOG)).stream()}
    assert {"/belief/tracks", "/plots/tilt", "/world/robot/ellipsoids"} <= entities


@pytest.mark.parametrize("time", ["nan", "-1", "1.01"])
def test_a_time_outside_the_run_is_refused_before_drawing(run, monkeypatch, capsys, time):
    (run / run_folder.LOG).touch()
    monkeypatch.setattr("hsr8.show.viewer.screenshot", lambda *_: pytest.fail("was drawn"))
    picture = str(run / "log.png")
    assert entry(["replay", str(run), "--screenshot", picture, f"--time={time}"]) == 2
    printed = capsys.readouterr().err
    assert printed.startswith(f"hsr8: --time: not in the run, got {float(time):g}; expected 0 to")
