import json
import os
import subprocess
import sys

import pytest

from hsr8.arithmetic import BEYOND, LEVEL_3, NATIVE, PORTABLE, choose_arithmetic

VARIABLES = ("OPENBLAS_CORETYPE", "NPY_DISABLE_CPU_FEATURES")
OLD = LEVEL_3 - {"avx2"}
NEW = LEVEL_3 | BEYOND["X86_V4"]


@pytest.fixture
def processor(tmp_path, monkeypatch):
    """Write the file of a processor with some features, before NumPy is imported."""
    monkeypatch.delitem(sys.modules, "numpy")
    for variable in VARIABLES:
        monkeypatch.setenv(variable, "to be put back")
        monkeypatch.delenv(variable)

    def having(features):
        file = tmp_path / "cpuinfo"
        file.write_text(f"processor\t: 0\nflags\t\t: {' '.join(sorted(features))} sse2\n")
        return file

    return having


@pytest.mark.parametrize("beyond", [[], ["X86_V4"], ["X86_V4", "AVX512_ICL"], list(BEYOND)])
def test_features_beyond_level_3_are_not_used(processor, monkeypatch, beyond):
    file = processor(LEVEL_3.union(*(BEYOND[name] for name in beyond)))
    assert choose_arithmetic(file) == PORTABLE
    assert os.environ["OPENBLAS_CORETYPE"] == "Haswell"
    assert os.environ.get("NPY_DISABLE_CPU_FEATURES", "").split() == beyond
    monkeypatch.setitem(sys.modules, "numpy", sys)  # a child process inherits the choice
    assert choose_arithmetic(file) == PORTABLE


@pytest.mark.parametrize("features", [set(), OLD])
def test_other_processors_are_native(processor, features, tmp_path):
    assert choose_arithmetic(processor(features)) == NATIVE
    assert choose_arithmetic(tmp_path / "absent") == NATIVE
    assert not set(VARIABLES) & set(os.environ)


@pytest.mark.parametrize("variable", VARIABLES)
def test_the_environment_of_the_user_wins(processor, monkeypatch, variable):
    monkeypatch.setenv(variable, "mine")
    assert choose_arithmetic(processor(NEW)) == NATIVE
    assert os.environ[variable] == "mine"


def test_after_an_import_of_numpy_it_is_native(processor, monkeypatch):
    monkeypatch.setitem(sys.modules, "numpy", sys)
    assert choose_arithmetic(processor(NEW)) == NATIVE
    assert not set(VARIABLES) & set(os.environ)


PROBE = """
import ctypes, json
import hsr8.arithmetic
import numpy as np
lines = open("/proc/self/maps").read().split()
blas = ctypes.CDLL(next(line for line in lines if "openblas64" in line))
blas.scipy_openblas_get_corename64_.restype = ctypes.c_char_p
used = {v["current"] for f in np.lib.introspect.opt_func_info("^(sin|exp|add)$").values()
        for v in f.values()}
print(json.dumps([hsr8.arithmetic.IN_FORCE, blas.scipy_openblas_get_corename64_().decode(),
                  sorted(used)]))
"""


def test_numpy_and_openblas_follow_the_choice():
    clean = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    probe = subprocess.run(
        [sys.executable, "-c", PROBE], env=clean, capture_output=True, text=True, check=True
    )
    in_force, core, used = json.loads(probe.stdout)
    if in_force == NATIVE:
        pytest.skip("not a processor of level 3")
    assert core == "Haswell"
    assert not [name for name in used if "V4" in name or "AVX512" in name]
