"""Files of colour tables: NumPy archives of the labels and the names of their classes."""

import zipfile
from pathlib import Path

import numpy as np

from vision.color import COLOR_CLASSES, ColorTable
from vision.errors import VisionError

SUFFIX = ".npz"
MAX_SIZE = 1_000_000  # of a table, unpacked; it has 34 kB [byte]


def save_table(table: ColorTable, path: Path) -> None:
    """Write `table` to `path`.

    Raises:
        OSError: the file cannot be written.
    """
    with path.open("wb") as file:
        np.savez_compressed(
            file, labels=table.labels, names=np.array([c.name for c in table.classes])
        )


def load_table(path: Path) -> ColorTable:
    """Read a table.

    Raises:
        VisionError: the file cannot be read, or is not a colour table of the present classes.
    """
    if path.exists() and not path.is_file():
        raise VisionError(f"{path}: not a regular file; expected a colour table")
    try:
        with zipfile.ZipFile(path) as parts:
            size = sum(part.file_size for part in parts.infolist())
        if size > MAX_SIZE:
            raise ValueError(size)
        with np.load(path, allow_pickle=False) as archive:
            labels, names = archive["labels"], archive["names"].tolist()
    except OSError as error:
        raise VisionError(f"{path}: {error.strerror or 'not a colour table'}") from None
    except Exception:  # a damaged archive raises anything
        raise VisionError(
            f"{path}: not a colour table; expected a file written by `hsr8 color-table`"
        ) from None
    if names != list(COLOR_CLASSES):
        raise VisionError(
            f"{path}: other colour classes, got {', '.join(map(str, names))}; "
            f"expected {', '.join(COLOR_CLASSES)}"
        )
    try:
        return ColorTable(COLOR_CLASSES, labels)
    except VisionError as error:
        raise VisionError(f"{path}: {error}") from None
