import numpy as np
import pytest

from tests.vision.scene import CAMERA, at, paint, pose
from vision.blob import find_blobs
from vision.colour import OUTSIDE, ColourTable
from vision.outline_kernel import trace
from vision.view import View

THINGS = [
    at(0.9, 4.0, "red", 0.09),
    at(1.6, 0.0, "green", 0.10),
    at(1.1, -30.0, "blue", 0.12),
    at(2.4, 18.0, "red", 0.05),
]


def arguments(pan, roll):
    gaze = pose(pan=pan, tilt=-0.3, roll=roll)
    labels = ColourTable().classify(paint(THINGS, gaze))
    blobs = find_blobs(labels, (20,) * 7)
    boxes = np.array([blob.box for blob in blobs], np.int32)
    extents = np.concatenate([blob.extents for blob in blobs])
    padded = np.pad(labels, 1, constant_values=OUTSIDE)
    return boxes, extents, padded, View(CAMERA, gaze).packed


@pytest.mark.parametrize(("pan", "roll"), [(0.0, 0.0), (0.2, 0.1), (-0.3, 1.5)])
def test_compiled_and_plain_agree(pan, roll):
    values = arguments(pan, roll)
    assert len(values[0]) >= 3
    for compiled, plain in zip(trace(*values), trace.py_func(*values), strict=True):
        np.testing.assert_allclose(compiled, plain, rtol=1e-12, atol=1e-14)
