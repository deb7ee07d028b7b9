"""Input: regular files of limited size, so that no pipe, device or sparse file stops a reader."""

import errno
import os
import stat

MAX_SIZE = 64_000_000  # of a text [byte]
_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a FIFO"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


def require_regular(path: str | os.PathLike[str]) -> None:
    """Require a regular file, or a link to one.

    Raises:
        OSError: there is no such file, or it is a folder, pipe, device or socket.
    """
    _require_regular_mode(os.stat(path).st_mode)


def read_bytes(path: str | os.PathLike[str], limit: int = MAX_SIZE) -> bytes:
    """Return the content of a regular file of at most `limit` bytes.

    Raises:
        OSError: it cannot be read, is not regular or is larger; `strerror` has the reason.
    """
    try:
        # Without O_NONBLOCK, opening a FIFO waits for its writer.
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    except ValueError as error:  # a null character in the path
        raise OSError(errno.EINVAL, str(error)) from None
    try:
        _require_regular_mode(os.fstat(descriptor).st_mode)
        with open(descriptor, "rb", closefd=False) as file:
            content = file.read(limit + 1)
    finally:
        os.close(descriptor)
    if len(content) > limit:
        raise OSError(errno.EFBIG, f"larger than {limit / 1e6:g} MB")
    return content


def read_text(path: str | os.PathLike[str], limit: int = MAX_SIZE) -> str:
    """Return the text of a regular file in UTF-8, with or without a byte order mark.

    Raises:
        OSError: as `read_bytes`, or it is not UTF-8.
    """
    content = read_bytes(path, limit)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        utf_16 = content.startswith((b"\xff\xfe", b"\xfe\xff"))
        got = "UTF-16" if utf_16 else f"byte 0x{content[error.start]:02x} at {error.start}"
        reason = f"wrong encoding, got {got}; expected UTF-8"
        raise OSError(errno.EILSEQ, reason) from None


def _require_regular_mode(mode: int) -> None:
    if not stat.S_ISREG(mode):
        kind = next((name for is_kind, name in _KINDS if is_kind(mode)), "a special file")
        raise OSError(errno.EINVAL, f"not a regular file, got {kind}")
