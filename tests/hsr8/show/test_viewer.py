import os
import socket
import sys
from pathlib import Path

import pytest

from hsr8.cli.main import entry
from hsr8.errors import UsageError
from hsr8.process.gl import VULKAN_LINE
from hsr8.show import viewer
from hsr8.show.viewer import Viewer


def failing(monkeypatch, message):
    """Let the viewer end at once with a message."""
    program = f"import sys; sys.exit({message!r})"
    monkeypatch.setattr(viewer, "command", lambda *words: [sys.executable, "-c", program])


@pytest.mark.parametrize(
    ("output", "message"),
    [
        ("Error: no graphics", "did not start: Error: no graphics"),
        (
            "\x1b[32m INFO\x1b[0m loading\nthread 'main' panicked at 'no \x1b[1mcontext\x1b[0m'\n",
            "did not start: thread 'main' panicked at 'no context'",
        ),
        ("INFO loading", "did not start\n"),
    ],
)
def test_the_error_of_a_viewer_contains_its_message_and_the_remedy(monkeypatch, output, message):
    failing(monkeypatch, output)
    with pytest.raises(UsageError, match=message) as caught:
        viewer.screenshot(Path("log.rrd"), 0.0, (64, 64))
    assert VULKAN_LINE in str(caught.value)


def test_a_damaged_log_is_not_blamed_on_the_graphics(monkeypatch):
    failing(monkeypatch, "ERROR Failed to load file: no metadata")
    with pytest.raises(UsageError, match=r"the log is damaged.*no metadata") as caught:
        viewer.screenshot(Path("log.rrd"), 0.0, (64, 64))
    assert VULKAN_LINE not in str(caught.value)


def test_a_viewer_is_polled_until_it_is_ready_or_times_out(monkeypatch):
    answers = iter([False, False, True])
    with Viewer([sys.executable, "-c", "import time; time.sleep(60)"]) as process:
        assert process.poll(lambda: next(answers))
        monkeypatch.setattr(viewer, "START_TIMEOUT", 0.1)
        assert not process.poll(lambda: False)


def test_the_port_of_a_viewer_is_waited_for():
    port = viewer.free_port()
    program = (
        "import socket, sys, time; time.sleep(0.3); "
        "server = socket.create_server(('127.0.0.1', int(sys.argv[1]))); "
        "server.accept(); time.sleep(60)"
    )
    with Viewer([sys.executable, "-c", program, str(port)]) as process:
        process.wait_for_port(port)
        with pytest.raises(OSError, match="in use"):
            socket.create_server((viewer.LOOPBACK, port))


VERBOSE_AND_STUBBORN = """
import signal, sys
signal.signal(signal.SIGTERM, signal.SIG_IGN)
print(100_000 * "x", "Error: still here", sep="\\n", file=sys.stderr, flush=True)
open(sys.argv[1], "w").close()
signal.pause()
"""


def test_a_viewer_that_ignores_sigterm_is_killed(tmp_path, monkeypatch):
    monkeypatch.setattr(viewer, "STOP_TIMEOUT", 0.2)
    done = tmp_path / "done"
    os.mkfifo(done)
    with Viewer([sys.executable, "-c", VERBOSE_AND_STUBBORN, str(done)]) as process:
        done.read_text()  # returns when all output is written
        assert not process.ended
    assert process.ended


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
    with viewer.live_view(kind) as view:
        (words,) = started
        assert words[words.index("--bind") + 1] == "127.0.0.1"
        assert f":{words[words.index('--port') + 1]}/" in view.address
        assert ("--serve-web" in words) == view.page.startswith("http://127.0.0.1:")
        assert bool(view.page) == (kind == "web")


def test_a_window_needs_a_display(monkeypatch):
    monkeypatch.setattr(viewer, "has_display", lambda: False)
    with (
        pytest.raises(UsageError, match=r"(?s)no display.*--view web"),
        viewer.live_view("native"),
    ):
        raise AssertionError


@pytest.mark.parametrize("words", [["--view", "native"]])
def test_without_a_display_nothing_runs(words, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(viewer, "has_display", lambda: False)
    assert entry(["run", "quick", *words, "--out", str(tmp_path / "runs")]) == 2
    assert "no display" in capsys.readouterr().err
    assert not (tmp_path / "runs").exists()
