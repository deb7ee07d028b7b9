"""Output files and image sizes that options name."""

import os
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from hsr8.errors import UsageError
from hsr8.files.atomic import require_replaceable


def require_file_name(option: str, file: Path, suffixes: Sequence[str]) -> None:
    """Check an output file before anything is computed.

    Args:
        option: option that names the file.
        file: file to write.
        suffixes: valid suffixes.

    Raises:
        UsageError: the suffix is not valid, or the file cannot be written.
    """
    if file.suffix.lower() not in suffixes:
        raise UsageError(f"{option} {file}: wrong suffix; expected {', '.join(suffixes)}")
    with writing(option, file):
        require_replaceable(file)


def require_new(option: str, path: Path) -> None:
    """Check a new output file or folder before anything is computed.

    Raises:
        UsageError: it exists, or cannot be written.
    """
    if os.path.lexists(path):
        raise UsageError(f"{option} {path}: exists; expected a new name")
    with writing(option, path):
        require_replaceable(path)


@contextmanager
def writing(option: str, file: Path) -> Iterator[None]:
    """Report an error of the system as an error of the option.

    Args:
        option: option that names the file.
        file: file that is written in the context.

    Raises:
        UsageError: the file cannot be written.
    """
    try:
        yield
    except OSError as error:
        raise UsageError(f"{option} {file}: cannot be written: {error.strerror}") from error


def parse_size(text: str) -> tuple[int, int]:
    """Return width and height [pixel] of ``960x540``.

    Raises:
        UsageError: the text is not a size, or a side is odd or out of range.
    """
    match = re.fullmatch(r"(\d{2,5})[x×](\d{2,5})", text.strip())
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    if any(side % 2 or not 64 <= side <= 4096 for side in size):
        raise UsageError(
            f"--size: got {text!r}; expected WIDTHxHEIGHT, even, 64 to 4096, such as 1280x720"
        )
    return size
