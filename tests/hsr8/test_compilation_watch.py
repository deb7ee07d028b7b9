import numpy as np
from numba import njit

from hsr8.compilation_watch import CompilationWatch


def nested(monkeypatch, module):
    @njit
    def inner(x):
        return x + 1.0

    @njit
    def outer(x):
        return inner(x)

    for function in (inner, outer):
        monkeypatch.setattr(function.py_func, "__module__", module)
    return outer


def test_the_watch_sees_a_compilation_and_not_a_call(monkeypatch):
    outer = nested(monkeypatch, "vision.trial")
    with CompilationWatch() as watch:
        outer(1.0)
        assert watch.count == 1
        seconds = watch.seconds
        outer(2.0)
    assert 0.0 < watch.seconds == seconds
    outer(np.float32(1.0))
    assert watch.count == 1


def test_compilations_of_hsr8_are_announced_by_package(monkeypatch):
    packages = []
    with CompilationWatch(packages.append) as watch:
        nested(monkeypatch, "walking.trial")(1.0)
        nested(monkeypatch, "somewhere.else")(1.0)
        nested(monkeypatch, "vision.trial")(1)
    assert packages == ["walking", "vision"]
    assert watch.count == 2
