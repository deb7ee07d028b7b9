"""The real program, which loads nothing and whose command lines are lines of Python."""

import os
import signal
import subprocess
import sys

import pytest

from hsr8.evaluation.sweep import fork_server as module
from hsr8.evaluation.sweep.fork_server import ForkServer

PROGRAM = """
import os, sys
import hsr8.cli.fork_server as program
LOAD
program.load_everything = lambda: None
program.entry = lambda words: exec(words[0]) or 0
raise SystemExit(program.main(sys.argv[1:]))
"""
# Opens a pipe that is closed by its end alone, and stays.
STAYS = "import signal; pipe = open({!r}, 'w'); pipe.write('on'); pipe.flush(); signal.pause()"
LIMIT = 60.0


@pytest.fixture
def doing(monkeypatch):
    """Let the program do something else when it loads."""

    def use(load=""):
        code = PROGRAM.replace("LOAD", load)
        monkeypatch.setattr(module, "COMMAND", [sys.executable, "-c", code])

    use()
    return use


@pytest.fixture
def server(doing):
    server = ForkServer()
    server.start(["pass"]).communicate(timeout=LIMIT)
    yield server
    server.close()


@pytest.fixture
def pipe(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    return tmp_path / "pipe"


def test_what_it_writes_and_its_exit_code_come_back(server):
    code = "import os; os.write(1, b'out\\xff'); os.write(2, b'err'); raise SystemExit({})"
    processes = [server.start([code.format(number)]) for number in range(5)]
    assert [p.communicate(timeout=LIMIT) for p in processes] == [("out\ufffd", "err")] * 5
    assert [p.returncode for p in processes] == list(range(5))


def test_much_output_does_not_block_it(server):
    process = server.start(["print('x' * 1_000_000)"])
    assert len(process.communicate(timeout=LIMIT)[0]) == 1_000_001


def test_a_run_is_a_process_and_a_session_of_its_own(server, monkeypatch):
    code = "import os, sys; print(os.getppid(), os.getpid() == os.getsid(0), sys.stdin.read())"
    printed, _ = server.start([code]).communicate(timeout=LIMIT)
    assert printed.split() == [str(server.pid), "True"]


def test_one_that_is_killed_takes_no_other_with_it(server, pipe):
    other = server.start([STAYS.format(str(pipe))])
    with pipe.open() as end:
        assert end.read(2) == "on"
        killed = server.start(["import os; os.kill(os.getpid(), 9)"])
        killed.communicate(timeout=LIMIT)
        assert killed.returncode == -signal.SIGKILL
        assert other.returncode is None
        other.terminate()
        assert end.read() == ""
    other.communicate(timeout=LIMIT)
    assert other.returncode == -signal.SIGTERM


def test_one_that_does_not_end_can_be_killed(server, pipe):
    deaf = "import signal; signal.signal(15, signal.SIG_IGN); "
    process = server.start([deaf + STAYS.format(str(pipe))])
    with pipe.open() as end:
        assert end.read(2) == "on"
        with pytest.raises(subprocess.TimeoutExpired):
            process.communicate(timeout=0.01)
        process.terminate()
        process.kill()
    process.communicate(timeout=LIMIT)
    assert process.returncode == -signal.SIGKILL


def test_runs_end_with_the_server(server, pipe):
    process = server.start([STAYS.format(str(pipe))])
    with pipe.open() as end:
        assert end.read(2) == "on"
        os.kill(server.pid, signal.SIGKILL)
        assert end.read() == ""
    with pytest.raises(OSError, match="ended"):
        process.communicate(timeout=LIMIT)
    assert process.returncode == -signal.SIGKILL
    assert server.gone
    with pytest.raises(OSError, match="ended"):
        server.start(["pass"])


def test_server_and_runs_end_with_a_sweep_that_is_killed(pipe):
    code = (
        "import os, sys; from hsr8.evaluation.sweep import fork_server as f;"
        f"f.COMMAND = [sys.executable, '-c', {PROGRAM.replace('LOAD', '')!r}];"
        f"server = f.ForkServer(); server.start([{STAYS.format(str(pipe))!r}]);"
        f"sys.stdin.read(); os.kill(os.getpid(), 9)"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE) as sweep:
        with pipe.open() as end:
            assert end.read(2) == "on"
            sweep.stdin.close()
            assert end.read() == ""
        assert sweep.wait() == -signal.SIGKILL


def test_a_program_that_does_not_load_says_why(doing):
    doing("raise ImportError('no such library')")
    server = ForkServer()
    with pytest.raises(OSError, match="no such library"):
        server.start(["pass"]).communicate(timeout=LIMIT)
    server.close()


def test_a_signal_while_it_loads_ends_it(doing, pipe):
    doing(STAYS.format(str(pipe)))
    server = ForkServer()
    process = server.start(["pass"])
    with pipe.open() as end:
        assert end.read(2) == "on"
        process.terminate()
        with pytest.raises(OSError, match="ended"):
            process.communicate(timeout=LIMIT)
    server.close()


def test_without_room_for_a_process_the_run_is_told(doing):
    doing("os.fork = lambda: open('/nowhere/at/all')")
    server = ForkServer()
    process = server.start(["pass"])
    with pytest.raises(OSError, match="cannot fork: No such file"):
        process.communicate(timeout=LIMIT)
    assert all(file.closed for file in process.files)
    server.close()


def test_what_it_takes_to_load_is_not_the_time_of_a_run(doing):
    doing("import time; time.sleep(3.0)")
    server = ForkServer()
    server.start(["print('done')"]).communicate(timeout=2.0)
    with pytest.raises(subprocess.TimeoutExpired):
        server.start(["import signal; signal.pause()"]).communicate(timeout=0.5)
    server.close()
