import io

import pytest

from hsr8.cli import kernel_progress
from hsr8.cli.kernel_progress import compile_announced
from hsr8.cli.main import entry
from hsr8.gl import BACKENDS


def compiling(total, compiled):
    def compile_kernels(show):
        for done in range(total + 1):
            show(done, total)
        return compiled

    return compile_kernels


@pytest.fixture
def sixty(monkeypatch):
    monkeypatch.setattr(kernel_progress, "compile_kernels", compiling(60, 12))


def test_without_a_terminal_there_are_a_few_lines(sixty):
    stream = io.StringIO()
    assert compile_announced(quiet=False, stream=stream) == 12
    lines = stream.getvalue().splitlines()
    assert [line.split(": ")[1] for line in lines] == [
        f"{done} of 60, 0 s" for done in (0, 15, 30, 45, 60)
    ]
    assert all(line.startswith("compiling the kernels") for line in lines)


def test_quiet_prints_nothing(sixty):
    stream = io.StringIO()
    assert compile_announced(quiet=True, stream=stream) == 12
    assert stream.getvalue() == ""


@pytest.mark.parametrize(("compiled", "text"), [(12, "12 compiled in"), (0, "all compiled before")])
def test_doctor_compiles_on_request(monkeypatch, capsys, compiled, text):
    monkeypatch.setattr("hsr8.cli.doctor.probe", lambda backend: BACKENDS[0])
    monkeypatch.setattr(kernel_progress, "compile_kernels", compiling(60, compiled))
    assert entry(["doctor"]) == 0
    assert "kernels" not in capsys.readouterr().out
    assert entry(["doctor", "--compile"]) == 0
    assert text in capsys.readouterr().out
