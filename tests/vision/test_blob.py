import cv2
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from vision.blob import find_blobs
from vision.tables import Blob

SMALLEST = np.full(7, 1, np.int32)


def mask_of(blob: np.record, runs: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    mask = np.zeros(shape, bool)
    for row, start, stop, label in runs[blob.first_run : blob.last_run].tolist():
        assert label == blob.label
        mask[row, start:stop] = True
    return mask


def area(blob: np.record, runs: np.ndarray) -> int:
    own = runs[blob.first_run : blob.last_run]
    return int((own[:, 2] - own[:, 1]).sum())


@given(seed=st.integers(0, 10_000), share=st.floats(0.0, 1.0))
def test_blobs_partition_the_colored_pixels(seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    labels = rng.integers(1, 8, (12, 17)).astype(np.uint8)
    labels[rng.random(labels.shape) < share] = 0
    covered = np.zeros(labels.shape, dtype=int)
    blobs, runs, _ = find_blobs(labels, SMALLEST)
    for blob in blobs.view(Blob):
        left, top, right, bottom = blob.box
        mask = mask_of(blob, runs, labels.shape)
        assert (labels[mask] == blob.label).all()
        assert area(blob, runs) == mask.sum()
        assert np.flatnonzero(mask.any(axis=0)).tolist() == list(range(left, right))
        assert np.flatnonzero(mask.any(axis=1)).tolist() == list(range(top, bottom))
        covered += mask
    assert np.array_equal(covered, (labels > 0).astype(int))


def test_extents_bound_every_row_and_column() -> None:
    labels = np.zeros((8, 10), np.uint8)
    labels[2:6, 3:7] = 1
    labels[2, 3] = 0
    labels[7, 9] = 2
    blobs, _, extents = find_blobs(labels, SMALLEST)
    blob, other = blobs.view(Blob)
    assert (blob.first_extent, other.first_extent, len(extents)) == (0, 16, 20)
    first, last, high, low = extents[:16].reshape(4, 4).tolist()
    assert first == [4, 3, 3, 3]
    assert last == [7, 7, 7, 7]
    assert high == [3, 2, 2, 2]
    assert low == [6, 6, 6, 6]


def test_blobs_at_each_border_are_cut() -> None:
    labels = np.zeros((6, 8), np.uint8)
    labels[0:2, 3:5] = 1
    labels[3:5, 0:2] = 2
    labels[3:5, 6:8] = 3
    labels[4:6, 3:5] = 4
    labels[2:4, 3:5] = 5
    blobs, _, _ = find_blobs(labels, SMALLEST)
    assert dict(zip(blobs["label"].tolist(), blobs["cut"].tolist(), strict=True)) == {
        1: True,
        2: True,
        3: True,
        4: True,
        5: False,
    }


@given(seed=st.integers(0, 10_000), share=st.floats(0.2, 1.0))
def test_blobs_are_the_components_that_opencv_finds(seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    labels = rng.integers(1, 3, (14, 19)).astype(np.uint8)
    labels[rng.random(labels.shape) < share] = 0
    table, runs, _ = find_blobs(labels, np.array([2, 2], np.int32))
    blobs = table.view(Blob)
    order = [(b.label, b.box[1]) for b in blobs]
    assert order == sorted(order)
    for label in (1, 2):
        _, _, stats, _ = cv2.connectedComponentsWithStats((labels == label).astype(np.uint8))
        rows = ((x, y, x + w, y + h, n) for x, y, w, h, n in stats[1:].tolist() if n >= 2)
        result = ((*b.box.tolist(), area(b, runs)) for b in blobs if b.label == label)
        assert sorted(result) == sorted(rows)
