"""Folder of temporary files."""

import tempfile

from hsr8.errors import UsageError


def require_temporary() -> None:
    """Check that temporary files can be written.

    Raises:
        UsageError: no folder for them can be written.
    """
    try:
        tempfile.gettempdir()
    except FileNotFoundError as error:
        raise UsageError(
            "TMPDIR: no folder for temporary files can be written, got /tmp, /var/tmp and the "
            "current folder; expected TMPDIR=DIR with a writable folder"
        ) from error
