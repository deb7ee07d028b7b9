import json
import os
import re
import subprocess
import sys

import pytest

from hsr8.process import arithmetic
from hsr8.process.arithmetic import BEYOND, LEVEL_3, NATIVE, PORTABLE, choose_arithmetic

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


PROBE = """
import ctypes, json
import hsr8.process.arithmetic
import numpy as np
lines = open("/proc/self/maps").read().split()
blas = ctypes.CDLL(next(line for line in lines if "openblas64" in line))
blas.scipy_openblas_get_corename64_.restype = ctypes.c_char_p
used = {v["current"] for f in np.lib.introspect.opt_func_info("^(sin|exp|add)$").values()
        for v in f.values()}
print(json.dumps([hsr8.process.arithmetic.IN_FORCE, blas.scipy_openblas_get_corename64_().decode(),
                  sorted(used)]))
"""


def probe(code, **variables):
    """Return what a new process prints, and its warnings."""
    clean = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=clean | variables,
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout), done.stderr


needs_level_3 = pytest.mark.skipif(
    not arithmetic._features(arithmetic._PROCESSOR) >= LEVEL_3, reason="processor below level 3"
)


def is_portable(core, used):
    return core == "Haswell" and not [name for name in used if "V4" in name or "AVX512" in name]


@needs_level_3
def test_numpy_and_openblas_follow_the_choice():
    (in_force, core, used), text = probe(PROBE)
    assert in_force == PORTABLE
    assert is_portable(core, used)
    assert not text


@needs_level_3
def test_after_an_import_of_numpy_the_arithmetic_is_that_in_use():
    """Where it differs, one warning at the import of the user shows the remedy, which works."""
    code = f"import numpy{PROBE}"
    (in_force, core, used), text = probe(code)
    assert (in_force == PORTABLE) == is_portable(core, used)
    assert text.count("NumPy was imported before hsr8") == (in_force == NATIVE)
    remedy = re.findall(r"(\w+)='([^']*)'", text)
    (in_force, core, used), text = probe(code, **dict(remedy))
    assert in_force == PORTABLE or not remedy
    assert not text or not remedy


@needs_level_3
def test_children_of_a_process_with_an_earlier_numpy_are_portable():
    child = "import hsr8.process.arithmetic as a, json; print(json.dumps(a.IN_FORCE))"
    call = f"subprocess.run([sys.executable, '-c', {child!r}], check=True)"
    assert probe(f"import numpy, sys, subprocess, hsr8; {call}")[0] == PORTABLE
