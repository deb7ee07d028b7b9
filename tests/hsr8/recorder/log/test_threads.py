"""A process that may hardly start threads: a log is refused before Rerun ends the process."""

import itertools
import json
import threading

import pytest

from hsr8.cli.main import entry
from hsr8.errors import RecordingFailed
from hsr8.recorder.log import threads
from hsr8.recorder.log.threads import require_threads

FAST = ("--body", "kinematic", "--camera", "analytic", "--quiet", "--duration", "0.5")


@pytest.fixture
def grant(monkeypatch):
    """Sets how many threads the system grants from now on."""
    start = threading.Thread.start

    def granted(count):
        numbers = itertools.count()

        def limited(thread):
            if next(numbers) >= count:
                raise RuntimeError("can't start new thread")
            start(thread)

        monkeypatch.setattr(threading.Thread, "start", limited)

    return granted


@pytest.mark.parametrize("count", [0, 1, threads.LOG_THREADS - 1])
def test_too_few_are_told_and_left_to_others(grant, tmp_path, count):
    before = threading.active_count()
    grant(count)
    with pytest.raises(RecordingFailed, match=f"takes {threads.LOG_THREADS} .* grants {count}\n"):
        require_threads(tmp_path)
    assert threading.active_count() == before


def test_as_many_as_it_takes_are_given_back(grant, tmp_path):
    before = threading.active_count()
    grant(threads.LOG_THREADS)
    require_threads(tmp_path)
    assert threading.active_count() == before


def test_a_run_is_refused_its_log_in_words_and_walks_without(grant, tmp_path, capfd):
    grant(3)
    assert entry(["run", "quick", "--out", str(tmp_path), *FAST]) == 3
    said = capfd.readouterr().err
    assert said.startswith("hsr8: cannot write the run folder")
    assert "--no-log" in said
    (folder,) = (tmp_path / "quick").iterdir()
    assert json.loads((folder / "manifest.json").read_text())["exit_reason"] == "failed"
    assert not (folder / "crash.txt").exists()
    assert not (folder / "log.rrd").exists()
    assert entry(["run", "quick", "--out", str(tmp_path), *FAST, "--no-log"]) == 1
