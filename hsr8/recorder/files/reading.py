"""Files of a run folder, which may come from anywhere, read up to a size."""

import errno
import stat
from pathlib import Path

LARGEST = 2**31  # no record of a run is larger [byte]
LARGEST_JSON = 2**24  # nor a manifest or a table of results [byte]


def read_bytes(path: Path, largest: int = LARGEST) -> bytes:
    """Content of `path`.

    Raises:
        OSError: it cannot be read, or is larger than a run can make it (a sparse file fits the
            disk but not memory).
    """
    must_fit(path, largest)
    return path.read_bytes()


def must_fit(path: Path, largest: int = LARGEST) -> None:
    """Refuse a file that is larger than a run can make it, and what is none, as a pipe.

    Raises:
        OSError: it is, or there is none.
    """
    found = path.stat()
    if not stat.S_ISREG(found.st_mode):
        raise OSError(errno.EINVAL, "it is no file", str(path))
    if found.st_size > largest:
        raise OSError(errno.EFBIG, f"it is larger than {largest:,} bytes", str(path))
