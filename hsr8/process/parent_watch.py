"""Parent-death signal: a process that ends with its parent, even if the parent is killed.

python parent_watch.py PARENT PROGRAM ARGUMENT...
"""

import ctypes
import os
import signal
import sys
from collections.abc import Sequence

PR_SET_PDEATHSIG = 1
ORPHAN = 130  # exit code of a process whose parent ended before the signal was set


def end_with_parent(parent: int, number: int = signal.SIGTERM) -> bool:
    """Let the kernel send this process a signal when its parent ends.

    Args:
        parent: process id.
        number: number of the signal.

    Returns:
        Whether the parent still runs.
    """
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, number)
    return os.getppid() == parent


def with_parent_watch(command: Sequence[str]) -> list[str]:
    """Return the command line of a process that becomes `command` and ends with this process."""
    isolated = (sys.executable, "-I", "-S", __file__)  # no modules of the current folder
    return [*isolated, str(os.getpid()), *command]


def main(arguments: list[str]) -> int:
    """Become the program in `arguments`, which begin with the process id of the parent."""
    parent, *command = arguments
    if end_with_parent(int(parent)):
        os.execv(command[0], command)
    return ORPHAN


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
