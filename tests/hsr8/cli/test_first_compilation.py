import numpy as np
import pytest
from numba import njit

import hsr8
from compilation import compiled
from hsr8.cli import first_compilation
from hsr8.cli.first_compilation import NOT_KEPT, TEXT, compile_all, two_processes
from hsr8.cli.main import entry
from hsr8.process.compilation_watch import CompilationWatch
from hsr8.process.gl import BACKENDS

SOURCE = "def doubled(x): return x + x"


def trial(module):
    """Return a compiled function of a module that has no file."""
    names = {"__name__": module}
    exec(SOURCE, names)
    return compiled(names["doubled"])


def compile_in(package):
    trial(f"{package}.trial")(1.0)


@pytest.fixture
def helper(tmp_path, monkeypatch):
    """Let the second process leave a line instead of a run."""
    lines = tmp_path / "lines"
    code = f"import time; time.sleep(0.3); print({{source!r}}, file=open({str(lines)!r}, 'a'))"
    monkeypatch.setattr(first_compilation, "CODE", code)
    return lines


def test_the_second_process_is_awaited_before_the_first_look(helper, capsys):
    with two_processes("rendered", quiet=False):
        for _ in range(2):
            compile_in("walking")
        compile_in("vision")
        assert helper.read_text() == "rendered\n"
    assert capsys.readouterr().err == f"{TEXT}\n"


def test_a_change_of_vision_alone_needs_no_second_process(helper, capsys):
    with two_processes("rendered", quiet=True):
        compile_in("vision")
    assert not helper.exists()
    assert capsys.readouterr().err == ""


def test_code_that_cannot_be_kept_is_announced_with_the_remedy(helper, monkeypatch, capsys):
    monkeypatch.setattr(first_compilation, "can_keep", lambda: False)
    with two_processes("rendered", quiet=False):
        compile_in("walking")
        compile_in("vision")
    assert not helper.exists()
    assert capsys.readouterr().err == f"{NOT_KEPT}\n"


@pytest.mark.timeout(600)
def test_a_run_compiles_nothing_afterwards(capsys):
    compile_all(quiet=True)
    with CompilationWatch() as watch:
        hsr8.run("quick", settings={"duration": 1.2})
        hsr8.run("paper", settings={"duration": 1.2})
    assert watch.count == 0


@pytest.mark.parametrize(("compiled", "text"), [(12, "compiled in"), (0, "all compiled before")])
def test_doctor_compiles_on_request(monkeypatch, capsys, compiled, text):
    monkeypatch.setattr("hsr8.cli.doctor.probe", lambda backend: BACKENDS[0])
    monkeypatch.setattr(first_compilation, "compile_all", lambda quiet: compiled)
    assert entry(["doctor"]) == 0
    assert "compiled code" not in capsys.readouterr().out
    assert entry(["doctor", "--compile"]) == 0
    assert text in capsys.readouterr().out


def test_the_watch_sees_a_compilation_and_not_a_call():
    function = trial("vision.trial")
    with CompilationWatch() as watch:
        function(1.0)
        assert watch.count == 1
        seconds = watch.seconds
        function(2.0)
    assert 0.0 < watch.seconds == seconds
    function(np.float32(1.0))
    assert watch.count == 1


def test_compilations_of_hsr8_are_announced_by_package():
    packages = []
    with CompilationWatch(packages.append) as watch:
        trial("walking.trial")(1.0)
        njit(lambda x: x)(1.0)
        trial("vision.trial")(1)
    assert packages == ["walking", "vision"]
    assert watch.count == 2
