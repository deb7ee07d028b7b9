"""A command line that ends with the process that started it, even if that one is killed.

python -m hsr8.cli.attended PARENT run quick --seed 3
"""

import ctypes
import os
import signal
import sys

from hsr8.cli.main import entry

PR_SET_PDEATHSIG = 1


def main(arguments: list[str]) -> int:
    """Run the command of `arguments`, which begin with the process id of the parent."""
    if sys.platform.startswith("linux"):
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
        if os.getppid() != int(arguments[0]):
            return 130
    return entry(arguments[1:])


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
