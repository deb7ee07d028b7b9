"""A process that ends with the one that started it, even if that one is killed.

python attended.py PARENT PROGRAM ARGUMENT...
"""

import ctypes
import os
import signal
import sys
from collections.abc import Sequence

PR_SET_PDEATHSIG = 1
ORPHAN = 130  # exit code of a run whose parent is gone before it begins


def ends_with(parent: int) -> bool:
    """Let the system terminate this process when its parent ends.

    Args:
        parent: process id.

    Returns:
        Whether the parent is still there.
    """
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    return os.getppid() == parent


def attended(command: Sequence[str]) -> list[str]:
    """Command line of a process that becomes `command`, and ends with this process."""
    alone = (sys.executable, "-I", "-S", __file__)  # not with modules of the present folder
    return [*alone, str(os.getpid()), *command]


def main(arguments: list[str]) -> int:
    """Become the program of `arguments`, which begin with the process id of the parent."""
    parent, *command = arguments
    if ends_with(int(parent)):
        os.execv(command[0], command)
    return ORPHAN


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
