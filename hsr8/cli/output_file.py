"""A file that an option of the command line names: checked, and its errors told."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hsr8.errors import UsageError


def require_png(option: str, file: Path) -> None:
    """Make sure that a picture can be called so, before anything is drawn.

    Args:
        option: that names the file.
        file: to be written.

    Raises:
        UsageError: it is no PNG, or its folder does not exist.
    """
    if file.suffix.lower() != ".png":
        raise UsageError(f"{option} {file}: give a file that ends in .png")
    if not file.parent.is_dir():
        raise UsageError(f"{option} {file}: cannot be written: there is no folder {file.parent}")


@contextmanager
def writing(option: str, file: Path) -> Iterator[None]:
    """Tell an error of the system as one of the option.

    Args:
        option: that names the file.
        file: written within the context.

    Raises:
        UsageError: it cannot be written.
    """
    try:
        yield
    except OSError as error:
        raise UsageError(f"{option} {file}: cannot be written: {error.strerror}") from error
