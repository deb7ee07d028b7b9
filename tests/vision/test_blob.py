import cv2
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from vision.blob import Blob, find_blobs

SMALLEST = (1,) * 7


def mask_of(blob: Blob, shape: tuple[int, ...]) -> np.ndarray:
    mask = np.zeros(shape, bool)
    for row, start, stop, label in blob.runs.tolist():
        assert label == blob.label
        mask[row, start:stop] = True
    return mask


def area(blob: Blob) -> int:
    return int((blob.runs[:, 2] - blob.runs[:, 1]).sum())


@given(seed=st.integers(0, 10_000), share=st.floats(0.0, 1.0))
def test_blobs_partition_the_colored_pixels(seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    labels = rng.integers(1, 8, (12, 17)).astype(np.uint8)
    labels[rng.random(labels.shape) < share] = 0
    covered = np.zeros(labels.shape, dtype=int)
    for blob in find_blobs(labels, SMALLEST):
        left, top, right, bottom = blob.box
        mask = mask_of(blob, labels.shape)
        assert (labels[mask] == blob.label).all()
        assert area(blob) == mask.sum()
        assert np.flatnonzero(mask.any(axis=0)).tolist() == list(range(left, right))
        assert np.flatnonzero(mask.any(axis=1)).tolist() == list(range(top, bottom))
        covered += mask
    assert np.array_equal(covered, (labels > 0).astype(int))


def test_extents_bound_every_row_and_column() -> None:
    labels = np.zeros((8, 10), np.uint8)
    labels[2:6, 3:7] = 1
    labels[2, 3] = 0
    (blob,) = find_blobs(labels, SMALLEST)
    first, last, high, low = blob.extents.reshape(4, 4).tolist()
    assert first == [4, 3, 3, 3]
    assert last == [7, 7, 7, 7]
    assert high == [3, 2, 2, 2]
    assert low == [6, 6, 6, 6]


def test_borders_are_flagged_one_by_one() -> None:
    labels = np.zeros((6, 8), np.uint8)
    labels[0:2, 3:5] = 1
    labels[3:5, 0:2] = 2
    labels[3:5, 6:8] = 3
    labels[4:6, 3:5] = 4
    labels[2:4, 3:5] = 5
    touches = {blob.label: blob.touches for blob in find_blobs(labels, SMALLEST)}
    assert touches == {
        1: (False, True, False, False),
        2: (True, False, False, False),
        3: (False, False, True, False),
        4: (False, False, False, True),
        5: (False, False, False, False),
    }


@given(seed=st.integers(0, 10_000), share=st.floats(0.2, 1.0))
def test_blobs_are_the_components_that_opencv_finds(seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    labels = rng.integers(1, 3, (14, 19)).astype(np.uint8)
    labels[rng.random(labels.shape) < share] = 0
    blobs = find_blobs(labels, (2, 2))
    assert [(b.label, b.box[1]) for b in blobs] == sorted((b.label, b.box[1]) for b in blobs)
    for label in (1, 2):
        _, _, stats, _ = cv2.connectedComponentsWithStats((labels == label).astype(np.uint8))
        rows = ((x, y, x + w, y + h, n) for x, y, w, h, n in stats[1:].tolist() if n >= 2)
        result = ((*b.box, area(b)) for b in blobs if b.label == label)
        assert sorted(result) == sorted(rows)
