"""Colour tables as files: NumPy archives of the labels and the names of their classes."""

import zipfile
from pathlib import Path

import numpy as np

from vision.color import COLOR_CLASSES, ColorTable
from vision.errors import VisionError

SUFFIX = ".npz"
LARGEST = 1_000_000  # neither the file nor what it unpacks to is larger [byte]
SHOWN = 200  # characters of another file's classes that are told


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

    Nothing but a small regular file is opened, and nothing in it is run.

    Raises:
        VisionError: there is no such file, it is no colour table, or it was made for other
            colour classes than those of this version.
    """
    try:
        _must_be_small(path)
        with np.load(path, allow_pickle=False) as archive:
            labels, names = archive["labels"], archive["names"].tolist()
    except VisionError:
        raise
    except OSError as error:
        raise VisionError(f"{path}: {error.strerror or 'no colour table'}") from None
    except Exception:  # readers of a forged archive raise anything
        raise VisionError(
            f"{path} is no colour table: it must hold the arrays 'labels' and 'names' "
            "(`hsr8 color-table` writes such files)"
        ) from None
    if names != list(COLOR_CLASSES):
        raise VisionError(
            f"{path} was made for the colour classes {', '.join(map(str, names))[:SHOWN]}; "
            f"those of this version are {', '.join(COLOR_CLASSES)}"
        )
    try:
        return ColorTable(COLOR_CLASSES, labels)
    except VisionError as error:
        raise VisionError(f"{path}: {error}") from None


def _must_be_small(path: Path) -> None:
    """Devices, pipes and archives that unpack without end are not read."""
    if path.exists() and not path.is_file():
        raise VisionError(f"{path} is no colour table: it is no file")
    with path.open("rb") as file:
        if file.seek(0, 2) > LARGEST:
            raise VisionError(f"{path} is no colour table: it is above {LARGEST:,} bytes")
        with zipfile.ZipFile(file) as packed:
            if sum(entry.file_size for entry in packed.infolist()) > LARGEST:
                raise VisionError(f"{path} is no colour table: it unpacks to too much")
