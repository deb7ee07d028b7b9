from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from navigation.gaze.blind import BlindGaze, SineSweep, StepSweep, TriangleSweep, stops
from navigation.gaze.gaze_map import GazeGrid
from navigation.parameters.navigation import NavigationParameters

P = NavigationParameters()
GAZE = replace(P.gaze, sweep_amplitude=1.1, sweep_period=5.0, sweep_stops=4, sweep_frames=2)
SWEPT = replace(P, gaze=GAZE)
GRID = GazeGrid(GAZE, 1.0, 0.8)
TIMES = np.linspace(0.0, 10.0, 1001)


def pans(policy, belief):
    return np.array([policy(SWEPT, GRID).pan(belief(time=t)) for t in TIMES])


@pytest.mark.parametrize("sweep", [SineSweep, TriangleSweep])
def test_a_sweep_is_periodic_and_odd_within_its_amplitude(sweep, belief):
    pan = pans(sweep, belief)
    half = len(TIMES) // 2
    assert pan[:half] == pytest.approx(pan[half : 2 * half], abs=1e-9)
    assert pan[: half + 1] == pytest.approx(-pan[half::-1], abs=1e-9)
    assert np.abs(pan).max() == pytest.approx(1.1, abs=1e-3)
    assert pan[:10].mean() > 0.0


def test_a_triangle_has_one_rate(belief):
    rates = np.abs(np.diff(pans(TriangleSweep, belief)) / np.diff(TIMES))
    assert np.median(rates) == pytest.approx(4.0 * 1.1 / 5.0)
    assert (rates < 0.99 * rates.max()).mean() < 0.02


def test_stops_go_from_side_to_side_and_back():
    assert stops(GAZE) == pytest.approx([-1.1, -1.1 / 3, 1.1 / 3, 1.1, 1.1 / 3, -1.1 / 3])
    assert stops(replace(GAZE, sweep_stops=2)) == pytest.approx([-1.1, 1.1])


def test_a_stop_lasts_for_its_number_of_sharp_frames(belief, view):
    sweep, visited, target = StepSweep(SWEPT, GRID), [], 0.0
    for k in range(60):
        blind = k % 3 == 0
        camera = replace_view(view(target, -0.5), blind)
        target = sweep.pan(belief(time=0.06 * k, camera=camera))
        visited.append(target)
    sequence = [visited[0], *(b for a, b in pairwise(visited) if a != b)]
    cycle = stops(GAZE) * 4
    assert sequence == pytest.approx(cycle[: len(sequence)])
    assert len(sequence) > 8


def replace_view(view, blind):
    return replace(view, blind=blind)


def test_a_stop_keeps_its_direction_in_the_world(belief, view):
    sweep = StepSweep(SWEPT, GRID)
    first = sweep.pan(belief(camera=view(2.0, 0.0)))
    turned = sweep.pan(belief(pose=(0.0, 0.0, -0.2), time=0.06, camera=view(2.0, 0.0)))
    assert turned == pytest.approx(first + 0.2)


def test_a_stop_that_the_head_does_not_reach_ends(belief, view):
    sweep = StepSweep(SWEPT, GRID)
    reached = {sweep.pan(belief(time=0.06 * k, camera=view(3.0, 0.0))) for k in range(200)}
    assert len(reached) == 4


def test_the_fixed_gaze_looks_ahead(belief):
    assert not np.any(pans(BlindGaze, belief))
