"""Files of pictures, checked before anything is drawn."""

from pathlib import Path

from hsr8.errors import UsageError


def require_png(option: str, file: Path) -> None:
    """Make sure that a picture can be called so.

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
