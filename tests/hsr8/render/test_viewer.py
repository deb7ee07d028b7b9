import os
import socket
import sys
from pathlib import Path

import pytest

from hsr8.errors import UsageError
from hsr8.gl import VULKAN_LINE
from hsr8.render import viewer
from hsr8.render.viewer import Viewer


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
