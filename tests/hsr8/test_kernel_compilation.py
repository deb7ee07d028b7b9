import numpy as np
import pytest
from numba import njit

from hsr8 import kernel_compilation
from hsr8.kernel_compilation import CompilationWatch, compile_kernels, listed


@pytest.mark.timeout(600)
def test_the_compilation_shows_its_progress_and_is_done_once():
    steps = []
    compile_kernels(lambda done, total: steps.append((done, total)))
    total = sum(map(len, listed().values()))
    assert steps[0] == (0, total)
    assert steps[-1] == (total, total)
    assert compile_kernels(lambda done, total: None) == 0


def test_the_watch_sees_a_compilation_and_not_a_call(monkeypatch):
    @njit
    def inner(x):
        return x + 1.0

    @njit
    def outer(x):
        return inner(x)

    for kernel in (inner, outer):
        monkeypatch.setattr(kernel.py_func, "__module__", "vision.trial_kernel")
    with CompilationWatch() as watch:
        outer(1.0)
        assert watch.count == 1
        seconds = watch.seconds
        outer(2.0)
    assert 0.0 < watch.seconds == seconds
    outer(np.float32(1.0))
    assert watch.count == 1


def test_only_the_first_listed_kernel_is_announced(monkeypatch):
    @njit
    def kernel(x):
        return x + 1.0

    @njit
    def other(x):
        return x + 1.0

    for function in (kernel, other):
        monkeypatch.setattr(function.py_func, "__module__", "vision.trial_kernel")
    monkeypatch.setattr(
        kernel_compilation, "listed", lambda: {"vision.trial_kernel": [("kernel", "")]}
    )
    calls = []
    with CompilationWatch(lambda: calls.append(len(calls))):
        other(1.0)
        assert calls == []
        kernel(1.0)
        kernel(1)
    assert calls == [0]
