"""Output files and image sizes that options name."""

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from hsr8.errors import UsageError


def require_file_name(option: str, file: Path, suffixes: Sequence[str]) -> None:
    """Check suffix and folder of an output file before anything is drawn.

    Args:
        option: option that names the file.
        file: file to write.
        suffixes: valid suffixes.

    Raises:
        UsageError: the suffix is not valid or the folder does not exist.
    """
    if file.suffix.lower() not in suffixes:
        raise UsageError(f"{option} {file}: wrong suffix; expected {', '.join(suffixes)}")
    if file.is_dir() or not file.parent.is_dir():
        reason = "it is a folder" if file.is_dir() else f"no folder {file.parent}"
        raise UsageError(f"{option} {file}: cannot be written: {reason}")


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
