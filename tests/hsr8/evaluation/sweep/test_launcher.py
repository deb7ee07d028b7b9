import pytest

from hsr8.evaluation.sweep import launcher as module
from hsr8.evaluation.sweep.launcher import Launcher, of_this_process


class Server:
    """Stands in for the process that forks."""

    def __init__(self):
        self.gone, self.closed, self.begun = False, False, []

    def start(self, words):
        self.begun.append(words)
        return self

    def close(self):
        self.closed = True


@pytest.fixture
def made(monkeypatch):
    """The servers that were made."""
    servers = []

    def make():
        servers.append(Server())
        return servers[-1]

    monkeypatch.setattr(module, "ForkServer", make)
    return servers


def test_one_process_forks_all_runs_and_there_is_none_before_the_first(made):
    launcher = Launcher()
    assert made == []
    for words in (["run", "quick"], ["run", "course"]):
        assert launcher.start(words) is made[0]
    assert made[0].begun == [["run", "quick"], ["run", "course"]]
    launcher.close()
    launcher.close()
    assert [server.closed for server in made] == [True]


def test_one_that_is_gone_is_replaced(made):
    launcher = Launcher()
    launcher.start(["run"])
    made[0].gone = True
    assert launcher.start(["run"]) is made[1]
    assert made[0].closed


def test_the_runs_of_one_worker_share_theirs():
    assert of_this_process() is of_this_process()
