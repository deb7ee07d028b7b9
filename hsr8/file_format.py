"""Numbers of file formats: which one a file has, and which one this version of hsr8 reads.

A binary file begins with a magic word, a name of seven letters and its format, a digit of base
36; a run folder has its number in the manifest. A number is raised whenever older files can no
longer be read, so that they are refused by it and not by what happens to be missing in them.
"""

from pathlib import Path

from hsr8.errors import UsageError
from hsr8.version import VERSION


def check_magic(content: bytes, magic: bytes, path: Path | str, file: str) -> None:
    """Refuse what does not begin with `magic`.

    Args:
        content: of the file.
        magic: what it must begin with, its format last.
        path: of the file, for messages.
        file: what the file is, for messages: ``tape``.

    Raises:
        UsageError: it is another kind of file, or of another format.
    """
    if content.startswith(magic):
        return
    found = content[len(magic) - 1 : len(magic)].decode("ascii", "replace")
    if not (content.startswith(magic[:-1]) and found.isalnum() and found.isascii()):
        raise UsageError(f"{path} is no {file} of this version of hsr8")
    check_number(int(found, 36), int(magic[-1:], 36), path, file)


def check_number(found: int, known: int, path: Path | str, file: str) -> None:
    """Refuse a format that is not the known one; arguments as `check_magic`.

    Raises:
        UsageError: it is another.
    """
    if found != known:
        raise UsageError(
            f"{path} is a {file} of format {found}, hsr8 {VERSION} reads format {known}: "
            "run the scenario again, or use the version of hsr8 that wrote it"
        )
