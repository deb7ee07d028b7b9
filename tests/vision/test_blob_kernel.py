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


@given(seed=st.integers(0, 10_000), width=st.integers(1, 50))
def test_runs_end_where_the_label_changes_for_every_width(seed: int, width: int) -> None:
    rng = np.random.default_rng(seed)
    labels = np.repeat(rng.integers(0, 3, (5, width)), rng.integers(1, 24, width), axis=1)
    labels = labels.astype(np.uint8)
    _, runs, _ = regions_of(labels, np.array([1, 1], np.int32))
    painted = np.zeros_like(labels)
    for row, start, stop, label in runs.tolist():
        assert (painted[row, start:stop] == 0).all()
        assert start == 0 or labels[row, start - 1] != label
        assert stop == labels.shape[1] or labels[row, stop] != label
        painted[row, start:stop] = label
    assert np.array_equal(painted, labels)
