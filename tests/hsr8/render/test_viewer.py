import os
import sys
from pathlib import Path

import pytest

from hsr8.errors import UsageError
from hsr8.gl import VULKAN_LINE
from hsr8.render import viewer


def test_the_line_that_says_what_went_wrong_is_found():
    said = (
        "\x1b[2m2026-01-01\x1b[0m \x1b[32m INFO\x1b[0m loading\n\n"
        "thread 'main' panicked at 'no \x1b[1mcontext\x1b[0m'\nstack backtrace:\n 24: _start\n"
    )
    assert viewer.complaint(said) == "thread 'main' panicked at 'no context'"
    assert viewer.complaint("INFO loading\nINFO loaded\n") == ""


def test_a_recording_without_times_yet_is_waited_for(monkeypatch):
    answers = [ConnectionError("has no timelines yet"), None]

    class Client:
        def set_time(self, *_, **__):
            answer = answers.pop(0)
            if answer:
                raise answer

    monkeypatch.setattr(viewer.clock, "sleep", lambda _: None)
    viewer._stop_at(Client(), Running(None), 1.0)
    assert answers == []
    answers = [ConnectionError("gone")]
    with pytest.raises(ConnectionError, match="gone"):
        viewer._stop_at(Client(), Running(1), 1.0)


class Running:
    """A process that has ended with `code`, or has not."""

    def __init__(self, code):
        self.ended = code is not None


def test_a_viewer_that_goes_down_leads_to_the_cure(monkeypatch):
    program = "import sys; sys.exit('Error: no graphics')"
    monkeypatch.setattr(viewer, "_command", lambda log, port: [sys.executable, "-c", program])
    with pytest.raises(UsageError, match="did not start: Error: no graphics") as caught:
        viewer.screenshot(Path("log.rrd"), 0.0, (64, 64))
    assert VULKAN_LINE in str(caught.value)


TALKATIVE_AND_DEAF = """
import signal, sys
signal.signal(signal.SIGTERM, signal.SIG_IGN)
print(100_000 * "x", "Error: still here", sep="\\n", file=sys.stderr, flush=True)
open(sys.argv[1], "w").close()
signal.pause()
"""


def test_a_viewer_that_says_much_and_does_not_end_is_ended(tmp_path, monkeypatch):
    monkeypatch.setattr(viewer, "ENDING", 0.2)
    done = tmp_path / "done"
    os.mkfifo(done)
    with viewer.running([sys.executable, "-c", TALKATIVE_AND_DEAF, str(done)]) as talks:
        done.read_text()  # comes back when all is said
        assert not talks.ended
    assert talks.ended


def test_a_damaged_log_is_not_laid_to_the_graphics(monkeypatch):
    program = "import sys; sys.exit('ERROR Failed to load file: no metadata')"
    monkeypatch.setattr(viewer, "_command", lambda log, port: [sys.executable, "-c", program])
    with pytest.raises(UsageError, match=r"the log is damaged.*no metadata") as caught:
        viewer.screenshot(Path("log.rrd"), 0.0, (64, 64))
    assert VULKAN_LINE not in str(caught.value)
