import pytest

from hsr8.evaluation.proportion import Proportion


def test_the_interval_is_wilson_s():
    some = Proportion.counted(19, 20)
    assert (some.low, some.high) == pytest.approx((0.7639, 0.9911), abs=1e-4)
    assert str(some) == "19 of 20, 95.0 % (76.4 to 99.1 %)"
    assert Proportion.counted(0, 5).low == 0.0
    assert Proportion.counted(5, 5).high == 1.0


def test_without_runs_the_interval_is_everything():
    assert Proportion.counted(0, 0) == Proportion(0, 0, 0.0, 0.0, 1.0)
    assert str(Proportion.counted(0, 0)) == "none"
