"""Portable arithmetic: identical bits on every x86-64 processor with AVX2 and FMA.

NumPy and OpenBLAS choose kernels by the processor. These kernels differ in the last bit, which
changes the course of a run. Limited to level 3 (AVX2 and FMA), results are identical. NumPy and
OpenBLAS read the environment once, so the package calls `choose_arithmetic` before it imports
NumPy. If NumPy was imported before, the processor decides whether that makes a difference.
"""

import ctypes
import os
import re
import sys
import warnings
from pathlib import Path

PORTABLE = "x86-64-v3"
NATIVE = "native"  # on this processor alone
LEVEL_3 = {"avx2", "bmi1", "bmi2", "f16c", "fma", "movbe"}
BEYOND = {  # targets of NumPy beyond level 3, and the features they need
    "X86_V4": {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"},
    "AVX512_ICL": {"avx512_vbmi2", "avx512_bitalg", "avx512_vpopcntdq"},
    "AVX512_SPR": {"avx512_fp16"},
}
CORE = "Haswell"  # processor of level 3 for which OpenBLAS computes
LATE = (
    "NumPy was imported before hsr8: the last bits of results depend on this processor and differ "
    "from those of `hsr8 run`; import hsr8 first, or start Python with {settings}"
)
_PROCESSOR = Path("/proc/cpuinfo")


def choose_arithmetic(processor: Path = _PROCESSOR) -> str:
    """Limit NumPy and OpenBLAS to level 3, unless the environment of the user decides otherwise.

    Args:
        processor: file with the features of the processor, in the format of Linux.

    Returns:
        `PORTABLE`, or `NATIVE` on other processors, if the environment decides otherwise, or if
        NumPy was imported before and uses features beyond level 3; the latter with a warning.
    """
    features = _features(processor)
    if not features >= LEVEL_3:
        return NATIVE
    wanted = {"OPENBLAS_CORETYPE": CORE}
    if beyond := [name for name, needed in BEYOND.items() if features >= needed]:
        wanted["NPY_DISABLE_CPU_FEATURES"] = " ".join(beyond)
    for name, value in wanted.items():
        if os.environ.setdefault(name, value) != value:
            return NATIVE
    if "numpy" not in sys.modules or _is_portable():
        return PORTABLE
    settings = " ".join(f"{name}='{value}'" for name, value in wanted.items())
    warnings.warn(LATE.format(settings=settings), stacklevel=4)  # where hsr8 is imported
    return NATIVE


def _is_portable() -> bool:
    """Return whether NumPy and OpenBLAS, which are loaded, use nothing beyond level 3."""
    extensions = sys.modules["numpy"].show_config(mode="dicts")["SIMD Extensions"]
    return BEYOND.keys().isdisjoint(extensions["found"]) and _cores() == {CORE}


def _cores() -> set[str]:
    """Return the processors for which the loaded libraries of OpenBLAS compute."""
    maps = Path("/proc/self/maps").read_text(encoding="utf-8", errors="replace")
    cores = set()
    for path in set(re.findall(r"/.*openblas.*\.so\S*", maps)):
        library = ctypes.CDLL(path)
        for name in ("scipy_openblas_get_corename64_", "scipy_openblas_get_corename"):
            if function := getattr(library, name, None):
                function.restype = ctypes.c_char_p
                cores.add(function().decode())
    return cores


def _features(processor: Path) -> set[str]:
    try:
        with processor.open() as lines:
            flags = next((line for line in lines if line.startswith("flags")), "")
    except OSError:
        return set()
    return set(flags.partition(":")[2].split())


IN_FORCE = choose_arithmetic()
