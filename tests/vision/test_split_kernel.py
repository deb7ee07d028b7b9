from itertools import pairwise

import numpy as np
import pytest

from vision.split_kernel import MIN_COLUMNS, MIN_INNER, borders, pieces

RNG = np.random.default_rng(0)


def outline(n=40):
    """Envelope of some things side by side, with noise, and which columns may be used."""
    marks = np.sort(RNG.choice(np.arange(1, n), RNG.integers(0, 5), replace=False))
    levels = RNG.uniform(-0.9, -0.1, len(marks) + 1)
    envelope = np.repeat(levels, np.diff([0, *marks, n])) + RNG.normal(0.0, 0.004, n)
    return envelope, RNG.random(n) < RNG.choice([0.6, 0.95, 1.0])


def joined(starts, jumps, n):
    """Starts of the pieces, those of too few columns joined to a neighbour."""
    starts = list(starts)
    while len(starts) > 1:
        widths = np.diff([*starts, n])
        k = int(np.argmin(widths))
        if widths[k] >= MIN_COLUMNS:
            break
        before = jumps[starts[k] - 1] if k > 0 else np.inf
        after = jumps[starts[k + 1] - 1] if k + 1 < len(starts) else np.inf
        del starts[k if before <= after else k + 1]
    return starts


def plainly(envelope, usable, start, width, least, drop, nearest, *outer):
    """The pieces by lists: ends, whether they are true, distance, azimuths and slopes."""
    n = len(envelope)
    jumps = np.abs(np.diff(envelope))
    starts = joined([0, *(np.flatnonzero(jumps > least) + 1)], jumps, n)

    def ends(last, beyond, at_border):
        if not 0 <= beyond < n:
            return at_border
        return usable[[last, beyond]].all() and (envelope[beyond] > envelope[last]) == nearest

    found = []
    for a, b in pairwise([*starts, n]):
        chosen = a + np.flatnonzero(usable[a:b])
        if len(chosen) < MIN_COLUMNS or 2 * len(chosen) < b - a:
            continue
        inner = chosen[((chosen > a) | (a == 0)) & ((chosen < b - 1) | (b == n))]
        chosen = inner if len(inner) >= MIN_INNER else chosen
        if (envelope[chosen] * drop <= 0.0).any():
            continue
        run = np.quantile(drop / envelope[chosen], 0.1 if nearest else 0.9)
        true = ends(a, a - 1, outer[0]), ends(b - 1, b, outer[1])
        row = (start + a * width, start + b * width, *true, run, len(chosen))
        found.append((row, start + width * (chosen + 0.5), envelope[chosen]))
    return found


@pytest.mark.parametrize("_", range(40))
def test_pieces_are_those_found_by_lists_and_by_the_plain_kernel(_):
    given = (*outline(), -0.4, 0.02, 0.03, RNG.choice([-0.5, -0.2, 0.2]))
    flags = [bool(flag) for flag in RNG.random(3) < 0.5]
    table, azimuth, slope = pieces(*given, *flags)
    for one, other in zip((table, azimuth, slope), pieces.py_func(*given, *flags), strict=True):
        assert np.array_equal(one, other)
    wanted = plainly(*given, *flags)
    assert np.allclose(table, np.array([row for row, *_ in wanted]).reshape(-1, 6), atol=1e-14)
    assert np.array_equal(azimuth, np.concatenate([[], *(a for _, a, _ in wanted)]))
    assert np.array_equal(slope, np.concatenate([[], *(s for *_, s in wanted)]))


def test_an_envelope_is_cut_at_its_steps_and_nowhere_else():
    envelope = np.repeat([-0.5, -0.3, -0.6], [5, 1, 6])
    assert borders(envelope, 0.1).tolist() == [0, 6, 12]  # one column is no piece
    assert borders(envelope, 1.0).tolist() == [0, 12]
    assert np.array_equal(borders(envelope, 0.1), borders.py_func(envelope, 0.1))
