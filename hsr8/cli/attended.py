"""A process that ends with the one that started it, even if that one is killed."""

import ctypes
import os
import signal

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
