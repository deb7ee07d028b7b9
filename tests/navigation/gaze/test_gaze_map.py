from math import pi

import numpy as np
import pytest

from navigation.gaze.gaze_map import GazeGrid, Votes
from navigation.parameters.gaze import GazeParameters

STEP = pi / 36


def grid(half_pan=0.75, half_tilt=0.6, *, step=STEP):
    return GazeGrid(GazeParameters(step=step, box_fraction=0.5), 2 * half_pan, 2 * half_tilt)


def random_votes(rng, n):
    return Votes(rng.uniform(-1.5, 1.5, n), rng.uniform(-1, 0.3, n), rng.uniform(0, 1, n) / n)


@pytest.mark.parametrize("step", np.linspace(0.03, 0.5, 24))
def test_the_cells_fill_the_limits_of_the_head(step):
    g = grid(step=step)
    assert pi / 2 - step < g.pan[-1] <= pi / 2 + 1e-9
    assert g.pan[0] == -g.pan[-1]
    assert g.tilt[0] == -pi / 3
    assert pi / 9 - step < g.tilt[-1] <= pi / 9 + 1e-9


def test_a_vote_counts_in_its_box_only():
    g = grid()
    pan, tilt = g.pan[20], g.tilt[8]
    region = g.gaze_map(Votes.one(pan, tilt, 0.7))
    inside = (np.abs(g.pan - pan) <= 0.75)[None, :] & (np.abs(g.tilt - tilt) <= 0.6)[:, None]
    assert region[8, 20] == 0.7
    assert np.array_equal(region > 0, inside)


def test_the_map_is_the_sum_of_regions_in_any_order():
    rng = np.random.default_rng(0)
    g, votes = grid(), random_votes(rng, 40)
    gm = g.gaze_map(votes)
    single = [Votes.one(*v) for v in zip(votes.pan, votes.tilt, votes.value, strict=True)]
    assert gm == pytest.approx(sum(g.gaze_map(v) for v in single))
    order = rng.permutation(40)
    shuffled = Votes(votes.pan[order], votes.tilt[order], votes.value[order])
    assert g.gaze_map(shuffled) == pytest.approx(gm)
    assert 0.0 <= gm.min() <= gm.max() <= 1.0


def test_a_map_of_zeros_keeps_the_gaze():
    g = grid()
    assert g.highest_centre(np.zeros((17, 37)), 0.33, -0.2) == (0.33, -0.2)


def test_the_largest_plateau_wins_then_the_nearest_then_the_smaller_pan():
    g = grid()
    gm = np.zeros((17, 37))
    gm[4:9, 2:7] = 1.0
    gm[8, 18] = 1.0
    assert g.highest_centre(gm, 0.0, g.tilt[8])[0] == pytest.approx(g.pan[4])
    gm[:] = 0.0
    gm[8, [10, 26]] = 1.0
    assert g.highest_centre(gm, 0.0, g.tilt[8]) == (g.pan[10], g.tilt[8])


def test_the_value_is_that_of_the_nearest_cell_also_outside_the_grid():
    g = grid()
    gm = np.arange(17.0 * 37.0).reshape(17, 37)
    rng = np.random.default_rng(3)
    for pan, tilt in zip(rng.uniform(-2, 2, 100), rng.uniform(-1.5, 0.8, 100), strict=True):
        row, column = np.argmin(np.abs(g.tilt - tilt)), np.argmin(np.abs(g.pan - pan))
        assert g.value_at(gm, pan, tilt) == gm[row, column]


def test_a_bent_or_hollow_plateau_gives_its_member_nearest_the_centroid():
    g = grid()
    gm = np.zeros((17, 37))
    gm[4:9, 10] = gm[8, 10:17] = 1.0  # centroid (7.1, 11.9), not of the plateau
    assert g.highest_centre(gm, 0.0, 0.0) == (g.pan[12], g.tilt[8])
    gm[:] = 0.0
    gm[4:9, 10:15] = 1.0
    gm[5:8, 11:14] = 0.5
    assert g.value_at(gm, *g.highest_centre(gm, 0.0, 0.0)) == 1.0


def test_votes_are_joined_in_order():
    nothing = Votes.join([])
    assert not grid().gaze_map(nothing).any()
    joined = Votes.join([Votes.one(0.1, -0.2, 0.3), nothing, Votes.one(0.4, -0.5, 0.6)])
    assert joined.pan.tolist() == [0.1, 0.4]
    assert joined.tilt.tolist() == [-0.2, -0.5]
    assert joined.value.tolist() == [0.3, 0.6]
