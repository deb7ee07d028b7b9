import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.recorder.time_histogram import LONGEST, RATIO, SHORTEST, TimeHistogram

durations = st.lists(st.floats(2 * SHORTEST, LONGEST / 2), min_size=1, max_size=60)


def counted(seconds):
    histogram = TimeHistogram()
    for value in seconds:
        histogram.add(value)
    return histogram


@given(durations, st.floats(0.01, 1.0))
def test_a_quantile_is_too_long_by_a_bin_at_most(seconds, share):
    exact = float(np.quantile(seconds, share, method="inverted_cdf"))
    found = counted(seconds).quantile(share)
    assert exact * (1 - 1e-9) <= found <= exact * RATIO * (1 + 1e-9)


@given(durations)
def test_mean_count_and_greatest_are_exact(seconds):
    histogram = counted(seconds)
    assert histogram.count == len(seconds)
    assert histogram.mean == pytest.approx(np.mean(seconds), rel=1e-12)
    assert histogram.max == max(seconds) == histogram.quantile(1.0)


def test_what_is_shorter_or_longer_than_the_bins_is_counted_too():
    histogram = counted([0.0, SHORTEST / 10, 10 * LONGEST])
    assert (histogram.count, histogram.max) == (3, 10 * LONGEST)
    assert histogram.quantile(0.5) <= SHORTEST * RATIO * (1 + 1e-9)
    assert histogram.quantile(1.0) == 10 * LONGEST


def test_nothing_took_no_time():
    empty = TimeHistogram()
    assert (empty.mean, empty.quantile(0.999), empty.max) == (0.0, 0.0, 0.0)
