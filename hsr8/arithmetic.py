"""Makes NumPy and OpenBLAS give the same bits on every x86-64 processor with AVX2 and FMA.

NumPy and OpenBLAS choose among kernels by the processor, and these differ in the last bit; a walk
among movers makes another walk of that. Told to use no more than level 3 (AVX2 and FMA), they
give the same bits on all. The package calls `choose_arithmetic` before anything of it imports
NumPy, which reads the environment once, as OpenBLAS does.
"""

import os
import sys
from pathlib import Path

PORTABLE = "x86-64-v3"
NATIVE = "native"  # of this processor alone
LEVEL_3 = {"avx2", "bmi1", "bmi2", "f16c", "fma", "movbe"}
BEYOND = {  # what NumPy dispatches to, and what the processor has if it can
    "X86_V4": {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"},
    "AVX512_ICL": {"avx512_vbmi2", "avx512_bitalg", "avx512_vpopcntdq"},
    "AVX512_SPR": {"avx512_fp16"},
}
_PROCESSOR = Path("/proc/cpuinfo")


def choose_arithmetic(processor: Path = _PROCESSOR) -> str:
    """Keep NumPy and OpenBLAS to level 3, unless the user's environment says otherwise.

    Args:
        processor: file with the features of the processor, as Linux gives it.

    Returns:
        `PORTABLE`, or `NATIVE` where the processor is another one, where NumPy was imported
        before, or where the environment asks for something else.
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
