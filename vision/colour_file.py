"""Colour tables as files: NumPy archives of the labels and the names of their classes."""

import zipfile
from pathlib import Path

import numpy as np

from vision.colour import COLOUR_CLASSES, ColourTable
from vision.errors import VisionError

SUFFIX = ".npz"


def save_table(table: ColourTable, path: Path) -> None:
    """Write `table` to `path`.

    Raises:
        OSError: the file cannot be written.
    """
    with path.open("wb") as file:
        np.savez_compressed(
            file, labels=table.labels, names=np.array([c.name for c in table.classes])
        )


def load_table(path: Path) -> ColourTable:
    """Read a table.

    Raises:
        VisionError: there is no such file, it is no colour table, or it was made for other
            colour classes than those of this version.
    """
    try:
        with np.load(path, allow_pickle=False) as archive:
            labels, names = archive["labels"], archive["names"].tolist()
    except OSError as error:
        raise VisionError(f"{path}: {error.strerror or 'no colour table'}") from None
    except (KeyError, ValueError, EOFError, AttributeError, TypeError, zipfile.BadZipFile):
        raise VisionError(
            f"{path} is no colour table: it must hold the arrays 'labels' and 'names' "
            "(`hsr8 colours` writes such files)"
        ) from None
    if names != list(COLOUR_CLASSES):
        raise VisionError(
            f"{path} was made for the colour classes {', '.join(map(str, names))}; "
            f"those of this version are {', '.join(COLOUR_CLASSES)}"
        )
    try:
        return ColourTable(COLOUR_CLASSES, labels)
    except VisionError as error:
        raise VisionError(f"{path}: {error}") from None
