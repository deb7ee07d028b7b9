import numpy as np
import pytest

from vision.split_kernel import borders, pieces

RNG = np.random.default_rng(0)


def outline(n=40):
    """Envelope of some objects side by side, with noise, and which columns may be used."""
    marks = np.sort(RNG.choice(np.arange(1, n), RNG.integers(0, 5), replace=False))
    levels = RNG.uniform(-0.9, -0.1, len(marks) + 1)
    envelope = np.repeat(levels, np.diff([0, *marks, n])) + RNG.normal(0.0, 0.004, n)
    return envelope, RNG.random(n) < RNG.choice([0.6, 0.95, 1.0])


@pytest.mark.parametrize("_", range(40))
def test_compiled_and_plain_pieces_agree(_):
    given = (*outline(), -0.4, 0.02, 0.03, RNG.choice([-0.5, -0.2, 0.2]))
    flags = [bool(flag) for flag in RNG.random(3) < 0.5]
    for one, other in zip(pieces(*given, *flags), pieces.py_func(*given, *flags), strict=True):
        assert np.array_equal(one, other)


def test_a_piece_has_the_ends_and_the_distance_of_its_object():
    """Two objects: the nearer one, on the left, occludes an end of the farther one."""
    envelope, usable = np.repeat([-0.3, -0.6], [6, 8]), np.ones(14, bool)
    table, azimuth, slope = pieces(envelope, usable, 0.1, 0.01, 0.1, -0.6, True, True, True)
    assert table == pytest.approx(
        np.array([[0.1, 0.16, 1.0, 0.0, 2.0, 5.0], [0.16, 0.24, 1.0, 1.0, 1.0, 7.0]])
    )
    inner = np.r_[0:5, 7:14]
    assert azimuth == pytest.approx(0.1 + 0.01 * (inner + 0.5))
    assert np.array_equal(slope, envelope[inner])


def test_an_envelope_is_cut_at_its_steps_and_nowhere_else():
    envelope = np.repeat([-0.5, -0.3, -0.6], [5, 1, 6])
    assert borders(envelope, 0.1).tolist() == [0, 6, 12]  # one column is too narrow
    assert borders(envelope, 1.0).tolist() == [0, 12]
    assert np.array_equal(borders(envelope, 0.1), borders.py_func(envelope, 0.1))
