import pytest

from hsr8.cli.main import entry
from hsr8.errors import UsageError
from hsr8.render import live_view, viewer


@pytest.mark.parametrize("kind", ["native", "web"])
def test_the_viewer_listens_to_this_machine_alone(kind, monkeypatch):
    monkeypatch.setattr(viewer, "executable", lambda: "rerun")
    words = live_view.command(kind, 1234, 5678)
    assert words[words.index("--bind") + 1] == "127.0.0.1"
    assert words[words.index("--port") + 1] == "1234"
    assert ("--serve-web" in words) == ("5678" in words) == (kind == "web")


def test_a_window_needs_a_display(monkeypatch):
    monkeypatch.setattr(viewer, "has_display", lambda: False)
    with (
        pytest.raises(UsageError, match=r"(?s)no display.*--view web"),
        live_view.live_view("native"),
    ):
        raise AssertionError


@pytest.mark.parametrize("words", [["--view"], ["--view", "native"]])
def test_without_a_display_nothing_is_run(words, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(viewer, "has_display", lambda: False)
    assert entry(["run", *words, "quick", "--out", str(tmp_path / "runs")]) == 2
    assert "no display" in capsys.readouterr().err
    assert not (tmp_path / "runs").exists()


def test_a_view_without_a_log_is_a_contradiction(tmp_path, capsys):
    assert entry(["run", "quick", "--view", "web", "--no-log", "--out", str(tmp_path)]) == 2
    assert "--no-log" in capsys.readouterr().err
