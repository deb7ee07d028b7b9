import cv2
import numpy as np

from vision.color import TABLE_SIZE
from vision.color_kernel import classify

RNG = np.random.default_rng(0)


def test_labels_are_those_of_the_rgb555_code_that_opencv_makes():
    image = RNG.integers(0, 256, (37, 53, 3)).astype(np.uint8)
    table = RNG.integers(0, 8, TABLE_SIZE).astype(np.uint8)
    codes = cv2.cvtColor(image, cv2.COLOR_RGB2BGR555).view(np.uint16).reshape(image.shape[:2])
    labels = classify(image, table)
    assert np.array_equal(labels, table[codes])
    assert np.array_equal(labels, classify.py_func(image, table))
