"""Portable arithmetic: identical bits on every x86-64 processor with AVX2 and FMA.

NumPy and OpenBLAS choose kernels by the processor. These kernels differ in the last bit, which
changes the course of a run. Limited to level 3 (AVX2 and FMA), results are identical. NumPy and
OpenBLAS read the environment once, so the package calls `choose_arithmetic` before it imports
NumPy.
"""

import os
import sys
from pathlib import Path

PORTABLE = "x86-64-v3"
NATIVE = "native"  # on this processor alone
LEVEL_3 = {"avx2", "bmi1", "bmi2", "f16c", "fma", "movbe"}
BEYOND = {  # targets of NumPy beyond level 3, and the features they need
    "X86_V4": {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"},
    "AVX512_ICL": {"avx512_vbmi2", "avx512_bitalg", "avx512_vpopcntdq"},
    "AVX512_SPR": {"avx512_fp16"},
}
_PROCESSOR = Path("/proc/cpuinfo")


def choose_arithmetic(processor: Path = _PROCESSOR) -> str:
    """Limit NumPy and OpenBLAS to level 3, unless the environment of the user decides otherwise.

    Args:
        processor: file with the features of the processor, in the format of Linux.

    Returns:
        `PORTABLE`, or `NATIVE` on other processors, after an earlier import of NumPy, or if the
        environment decides otherwise.
    """
    features = _features(processor)
    if not features >= LEVEL_3:
        return NATIVE
    wanted = {"OPENBLAS_CORETYPE": "Haswell"}
    if beyond := [name for name, needed in BEYOND.items() if features >= needed]:
        wanted["NPY_DISABLE_CPU_FEATURES"] = " ".join(beyond)
    if "numpy" not in sys.modules:
        os.environ.update(wanted | {k: os.environ[k] for k in wanted if k in os.environ})
    in_force = all(os.environ.get(name) == value for name, value in wanted.items())
    return PORTABLE if in_force else NATIVE


def _features(processor: Path) -> set[str]:
    try:
        with processor.open() as lines:
            flags = next((line for line in lines if line.startswith("flags")), "")
    except OSError:
        return set()
    return set(flags.partition(":")[2].split())


IN_FORCE = choose_arithmetic()
