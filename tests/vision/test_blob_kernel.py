import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from vision.blob_kernel import regions_of


@given(seed=st.integers(0, 10_000), share=st.floats(0.2, 1.0))
def test_compiled_and_plain_regions_agree(seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    labels = rng.integers(1, 4, (9, 11)).astype(np.uint8)
    labels[rng.random(labels.shape) < share] = 0
    smallest = np.array([1, 2, 3], np.int32)
    for compiled, plain in zip(
        regions_of(labels, smallest), regions_of.py_func(labels, smallest), strict=True
    ):
        assert np.array_equal(compiled, plain)
