"""Blobs: connected regions of one colour."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.colour import Labels

Mask = NDArray[np.bool_]
Index = NDArray[np.signedinteger]

SHORT = 1 << 16  # labels of 16 bits


@dataclass(frozen=True, slots=True)
class Blob:
    """One connected region of one colour.

    Attributes:
        label: of its colour.
        box: left, top, right, bottom pixel, right and bottom exclusive.
        area: [pixel].
        mask: which pixels of the box belong to it (bottom - top, right - left).
        touches: whether it touches the left, top, right and bottom border.
    """

    label: int
    box: tuple[int, int, int, int]
    area: int
    mask: Mask
    touches: tuple[bool, bool, bool, bool]

    @property
    def cut(self) -> bool:
        """Whether the border of the image cuts it."""
        return any(self.touches)

    def row_extents(self) -> tuple[Index, Index]:
        """First and last (exclusive) column of each row, in image pixels."""
        first, last = _extents(self.mask)
        return first + self.box[0], last + self.box[0]

    def column_extents(self) -> tuple[Index, Index]:
        """First and last (exclusive) row of each column, in image pixels."""
        first, last = _extents(self.mask.T)
        return first + self.box[1], last + self.box[1]


def find_blobs(labels: Labels, min_area: tuple[int, ...]) -> list[Blob]:
    """Blobs of a classified image (h, w), 8-connected, by label, then top, then left.

    Args:
        labels: label of each pixel, 0 for background.
        min_area: smallest blob of label 1, 2, ... [pixel].
    """
    height, width = labels.shape
    blobs: list[Blob] = []
    x_all, y_all, w_all, h_all = cv2.boundingRect(labels)
    if w_all == 0:
        return blobs
    coloured = labels[y_all : y_all + h_all, x_all : x_all + w_all]
    for label, smallest in enumerate(min_area, start=1):
        mask = (coloured == label).view(np.uint8)
        x0, y0, w0, h0 = cv2.boundingRect(mask)
        if w0 * h0 < smallest:
            continue
        # Short labels make it several times faster; no two components share 2 x 2 pixels.
        short = ((w0 + 1) // 2) * ((h0 + 1) // 2) < SHORT
        _, components, stats, _ = cv2.connectedComponentsWithStats(
            mask[y0 : y0 + h0, x0 : x0 + w0],
            connectivity=8,
            ltype=cv2.CV_16U if short else cv2.CV_32S,
        )
        for i, (x, y, w, h, area) in enumerate(stats.tolist()):
            if i == 0 or area < smallest:  # the first is what is not of this colour
                continue
            left, top = x_all + x0 + x, y_all + y0 + y
            box = (left, top, left + w, top + h)
            blobs.append(
                Blob(
                    label=label,
                    box=box,
                    area=area,
                    mask=components[y : y + h, x : x + w] == i,
                    touches=(left == 0, top == 0, box[2] == width, box[3] == height),
                )
            )
    return blobs


def _extents(mask: Mask) -> tuple[Index, Index]:
    """First and last (exclusive) True of each row; every row has one."""
    return mask.argmax(axis=1), mask.shape[1] - mask[:, ::-1].argmax(axis=1)
