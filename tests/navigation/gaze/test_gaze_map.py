"""Regions of votes (5), their map (6) and its highest centre."""

from math import pi

import numpy as np
import pytest

from navigation.gaze.grid import GazeGrid
from navigation.gaze.integrated import Votes, gaze_map, highest_centre, one_vote
from navigation.parameters.gaze import GazeParameters

GRID = GazeGrid.of(GazeParameters(step=pi / 36))
FOV = (1.5, 1.2)


def random_votes(rng, n):
    return Votes(rng.uniform(-1.5, 1.5, n), rng.uniform(-1, 0.3, n), rng.uniform(0, 1, n) / n)


def test_a_vote_counts_in_its_box_only():
    pan, tilt = GRID.pan[20], GRID.tilt[8]
    region = gaze_map(one_vote(pan, tilt, 0.7), GRID, FOV)
    inside = (np.abs(GRID.pan - pan) <= 0.75)[None, :] & (np.abs(GRID.tilt - tilt) <= 0.6)[:, None]
    assert region[8, 20] == 0.7
    assert np.array_equal(region > 0, inside)


def test_the_map_is_the_sum_of_regions_in_any_order():
    rng = np.random.default_rng(0)
    votes = random_votes(rng, 40)
    gm = gaze_map(votes, GRID, FOV)
    single = [one_vote(*v) for v in zip(votes.pan, votes.tilt, votes.value, strict=True)]
    assert gm == pytest.approx(sum(gaze_map(v, GRID, FOV) for v in single))
    order = rng.permutation(40)
    shuffled = Votes(votes.pan[order], votes.tilt[order], votes.value[order])
    assert gaze_map(shuffled, GRID, FOV) == pytest.approx(gm)
    assert 0.0 <= gm.min() <= gm.max() <= 1.0


def test_the_largest_plateau_wins_then_the_nearest_then_the_smaller_pan():
    gm = np.zeros((17, 37))
    gm[4:9, 2:7] = 1.0
    gm[8, 18] = 1.0
    assert highest_centre(gm, GRID, (0.0, GRID.tilt[8]))[0] == pytest.approx(GRID.pan[4])
    gm[:] = 0.0
    gm[8, [10, 26]] = 1.0
    assert highest_centre(gm, GRID, (0.1, GRID.tilt[8])) == (GRID.pan[26], GRID.tilt[8])
    assert highest_centre(gm, GRID, (0.0, GRID.tilt[8])) == (GRID.pan[10], GRID.tilt[8])


def test_a_bent_or_hollow_plateau_gives_its_member_nearest_the_centroid():
    gm = np.zeros((17, 37))
    gm[4:9, 10] = gm[8, 10:17] = 1.0  # centroid (7.1, 11.9), not of the plateau
    assert highest_centre(gm, GRID, (0.0, 0.0)) == (GRID.pan[12], GRID.tilt[8])
    gm[:] = 0.0
    gm[4:9, 10:15] = 1.0
    gm[5:8, 11:14] = 0.5
    pan, tilt = highest_centre(gm, GRID, (0.0, 0.0))
    assert gm[GRID.tilt == tilt, GRID.pan == pan] == [1.0]
