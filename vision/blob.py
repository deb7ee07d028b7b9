"""Blobs: connected components of one colour class."""

import numpy as np
from numpy.typing import NDArray

from vision.blob_kernel import regions_of
from vision.color import Labels
from vision.value import value

Table = NDArray[np.int32]


@value
class Blob:
    """Connected component of one colour class.

    Attributes:
        label: of its colour class.
        box: left, top, right, bottom pixel, right and bottom exclusive.
        runs: run-length encoding: row, first and last (exclusive) column and label of each run,
            by row, then column (n, 4) [pixel].
        extents: first and last (exclusive) column of each row, then first and last (exclusive)
            row of each column, concatenated (2 (bottom - top) + 2 (right - left),) [pixel].
        touches: whether it touches the left, top, right and bottom border.
    """

    label: int
    box: tuple[int, int, int, int]
    runs: Table
    extents: Table
    touches: tuple[bool, bool, bool, bool]

    @property
    def cut(self) -> bool:
        """Whether it touches a border."""
        return any(self.touches)


def find_blobs(labels: Labels, min_area: tuple[int, ...]) -> list[Blob]:
    """Return the 8-connected components of a label image (h, w), by label, then top, then left.

    Args:
        labels: label of each pixel, 0 for background.
        min_area: minimum area of blobs of label 1, 2, ... [pixel].
    """
    height, width = labels.shape
    regions, runs, extents = regions_of(labels, np.array(min_area, np.int32))
    blobs: list[Blob] = []
    first_run = first_extent = 0
    for left, top, right, bottom, _, label, count in regions.tolist():
        last_run = first_run + count
        last_extent = first_extent + 2 * (bottom - top + right - left)
        blobs.append(
            Blob(
                label,
                (left, top, right, bottom),
                runs[first_run:last_run],
                extents[first_extent:last_extent],
                (left == 0, top == 0, right == width, bottom == height),
            )
        )
        first_run, first_extent = last_run, last_extent
    return blobs
