"""Format numbers of files: a file of another format is refused by its number.

A binary file begins with a magic word: a name of seven letters and its format, a digit of base 36.
The format of a run folder is in its manifest. A format number is raised whenever older files can
no longer be read.
"""

from pathlib import Path

from hsr8.errors import UsageError
from hsr8.version import VERSION


def check_magic(content: bytes, magic: bytes, path: Path | str, file: str) -> None:
    """Refuse content that does not begin with `magic`.

    Args:
        content: of the file.
        magic: expected first bytes, the format last.
        path: of the file, for messages.
        file: kind of file, for messages: ``tape``.

    Raises:
        UsageError: the file is of another kind or format.
    """
    if content.startswith(magic):
        return
    digit = content[len(magic) - 1 : len(magic)].decode("ascii", "replace")
    if not (content.startswith(magic[:-1]) and digit.isalnum() and digit.isascii()):
        raise UsageError(f"{path}: not a {file} of hsr8")
    check_number(int(digit, 36), int(magic[-1:], 36), path, file)


def check_number(number: int, expected: int, path: Path | str, file: str) -> None:
    """Refuse a format `number` other than `expected`; for the rest see `check_magic`.

    Raises:
        UsageError: the formats differ.
    """
    if number != expected:
        raise UsageError(
            f"{path}: {file} of format {number}, hsr8 {VERSION} reads format {expected}: "
            "run the scenario again, or use the version of hsr8 that wrote it"
        )
