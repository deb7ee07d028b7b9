import numpy as np
import pytest

from tests.vision.scene import CAMERA, at, pose, traced
from vision.blob import find_blobs
from vision.color import OUTSIDE
from vision.outline_kernel import angles, envelopes, trace
from vision.view import View

OBSTACLES = [
    at(0.9, 4.0, "red", 0.09),
    at(1.6, 0.0, "green", 0.10),
    at(1.1, -30.0, "blue", 0.12),
    at(2.4, 18.0, "red", 0.05),
]


def observed(pan, roll):
    """Blobs, padded labels and packed view of the obstacles."""
    gaze = pose(pan=pan, tilt=-0.3, roll=roll)
    blobs, padded, _ = traced(OBSTACLES, gaze)
    return blobs, padded, View(CAMERA, gaze).packed


@pytest.mark.parametrize(("pan", "roll"), [(0.0, 0.0), (0.2, 0.1), (-0.3, 1.5)])
def test_compiled_and_plain_agree(pan, roll):
    blobs, *rest = observed(pan, roll)
    assert len(blobs) >= 3
    boxes = np.array([blob.box for blob in blobs], np.int32)
    values = boxes, np.concatenate([blob.extents for blob in blobs]), *rest
    for compiled, plain in zip(trace(*values), trace.py_func(*values), strict=True):
        np.testing.assert_allclose(compiled, plain, rtol=1e-12, atol=1e-14)
    for blob, box in zip(blobs, boxes, strict=True):
        values = box, blob.extents, blob.runs, *rest
        for compiled, plain in zip(envelopes(*values), envelopes.py_func(*values), strict=True):
            np.testing.assert_allclose(compiled, plain, rtol=1e-12, atol=1e-14)


def test_envelopes_bound_the_directions_of_all_pixels():
    """Lowest and highest slope of a blob near each azimuth, from the middles of its pixels."""
    blobs, padded, view = observed(0.1, 0.05)
    for blob in blobs:
        box = np.array(blob.box, np.int32)
        start, width, size, (low, high), _ = envelopes(box, blob.extents, blob.runs, padded, view)
        middles = [
            (column + 0.5, row + 0.5)
            for row, first, last, _ in blob.runs.tolist()
            for column in range(first, last)
        ]
        for u, v in middles:
            azimuth, slope = angles(view, u, v)
            column = int((azimuth - start) / width)
            near = slice(max(column - 1, 0), column + 2)
            assert low[near].min() - size < slope < high[near].max() + size


def test_no_pixel_of_a_rim_is_without_size():
    """Seen steeply, the ends of rows in the middle column run along one slope."""
    labels = np.zeros((CAMERA.height, CAMERA.width), np.uint8)
    labels[20:100, 40 : CAMERA.width // 2] = 1
    (blob,) = find_blobs(labels, (20,))
    box, padded = np.array([blob.box], np.int32), np.pad(labels, 1, constant_values=OUTSIDE)
    _, _, sizes, *_ = trace(box, blob.extents, padded, View(CAMERA, pose(tilt=1.2)).packed)
    assert 0.0 < sizes.min() < 1e-3
