import sys

import pytest

from hsr8.cli.main import entry
from hsr8.errors import UsageError
from hsr8.render import live_view, viewer


@pytest.mark.parametrize("kind", ["native", "web"])
def test_the_viewer_listens_to_this_machine_only(kind, monkeypatch):
    started = []

    class Started(viewer.Viewer):
        def __init__(self, words):
            started.append(words)
            super().__init__([sys.executable, "-c", "import time; time.sleep(60)"])

        def wait_for_port(self, port):
            pass

    monkeypatch.setattr(viewer, "executable", lambda: "rerun")
    monkeypatch.setattr(viewer, "has_display", lambda: True)
    monkeypatch.setattr(viewer, "Viewer", Started)
    with live_view.live_view(kind) as view:
        (words,) = started
        assert words[words.index("--bind") + 1] == "127.0.0.1"
        assert f":{words[words.index('--port') + 1]}/" in view.address
        assert ("--serve-web" in words) == view.page.startswith("http://127.0.0.1:")
        assert bool(view.page) == (kind == "web")


def test_a_window_needs_a_display(monkeypatch):
    monkeypatch.setattr(viewer, "has_display", lambda: False)
    with (
        pytest.raises(UsageError, match=r"(?s)no display.*--view web"),
        live_view.live_view("native"),
    ):
        raise AssertionError


@pytest.mark.parametrize("words", [["--view", "native"]])
def test_without_a_display_nothing_runs(words, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(viewer, "has_display", lambda: False)
    assert entry(["run", "quick", *words, "--out", str(tmp_path / "runs")]) == 2
    assert "no display" in capsys.readouterr().err
    assert not (tmp_path / "runs").exists()
