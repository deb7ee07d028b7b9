"""Write hsr8/kernels.txt: the kernels of two short runs, with the types of their arguments."""

import os
import subprocess
import sys

from hsr8.kernel_compilation import LIST

RUN = """
import sys
import hsr8
hsr8.run("quick")
hsr8.run("course", settings=["duration=4"])  # with obstacles that hide each other
for name, module in list(sys.modules.items()):
    if name.endswith("_kernel"):
        for kernel in vars(module).values():
            if hasattr(kernel, "py_func") and kernel.__module__ == name:
                for signature in kernel.stats.cache_hits:
                    print(f"{name}.{kernel.__name__} {signature}")
                for signature in kernel.stats.cache_misses:
                    print("compiled", name, signature, file=sys.stderr)
"""


def loaded() -> list[str]:
    """Return the kernels that a run loads from disk if it compiles none."""
    for _ in range(2):
        done = subprocess.run(
            [sys.executable, "-c", RUN], capture_output=True, text=True, check=True, env=os.environ
        )
        if "compiled" not in done.stderr:
            break
    return sorted(done.stdout.splitlines())


if __name__ == "__main__":
    LIST.write_text("\n".join([*loaded(), ""]), encoding="utf-8")
