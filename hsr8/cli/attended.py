"""A command line that ends with the process that started it, even if that one is killed.

python -m hsr8.cli.attended PARENT run quick --seed 3
"""

import ctypes
import os
import signal
import sys

from hsr8.cli.main import entry

PR_SET_PDEATHSIG = 1
ORPHAN = 130  # exit code of a run whose parent is gone before it begins


def main(arguments: list[str]) -> int:
    """Run the command of `arguments`, which begin with the process id of the parent."""
    return entry(arguments[1:]) if ends_with(int(arguments[0])) else ORPHAN


def ends_with(parent: int) -> bool:
    """Let the system terminate this process when its parent ends.

    Args:
        parent: process id.

    Returns:
        Whether the parent is still there.
    """
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    return os.getppid() == parent


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
