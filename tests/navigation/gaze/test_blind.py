from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

TIMES = np.linspace(0.0, 10.0, 1001)
SWEEP = {"sweep_amplitude": 1.1, "sweep_period": 5.0, "sweep_stops": 4, "sweep_frames": 2}
STOPS = [-1.1, -1.1 / 3, 1.1 / 3, 1.1, 1.1 / 3, -1.1 / 3]


@pytest.fixture
def pans(gaze, belief):
    def make(mode):
        choose = gaze(mode=mode, **SWEEP)
        return np.array([choose(belief(time=time)).pan for time in TIMES])

    return make


def test_a_triangle_is_periodic_and_odd_within_its_amplitude_and_has_one_rate(pans):
    pan, half = pans("triangle"), len(TIMES) // 2
    assert pan[:half] == pytest.approx(pan[half : 2 * half], abs=1e-9)
    assert pan[: half + 1] == pytest.approx(-pan[half::-1], abs=1e-9)
    assert np.abs(pan).max() == pytest.approx(1.1, abs=1e-3)
    assert pan[:10].mean() > 0.0
    rates = np.abs(np.diff(pan) / np.diff(TIMES))
    assert np.median(rates) == pytest.approx(4.0 * 1.1 / 5.0)
    assert (rates < 0.99 * rates.max()).mean() < 0.02


@pytest.mark.parametrize(("number", "cycle"), [(4, STOPS), (2, [-1.1, 1.1])])
def test_stops_go_from_side_to_side_and_back_each_for_its_sharp_frames(
    number, cycle, gaze, belief, view
):
    choose, visited, target = gaze(mode="steps", **SWEEP | {"sweep_stops": number}), [], 0.0
    for k in range(60):
        camera = replace(view(target, -0.5), blind=k % 3 == 0)
        target = choose(belief(time=0.06 * k, camera=camera)).pan
        visited.append(target)
    sequence = [visited[0], *(b for a, b in pairwise(visited) if a != b)]
    assert sequence == pytest.approx((cycle * 20)[: len(sequence)])
    assert len(sequence) > 8


def test_a_stop_keeps_its_direction_in_the_world(gaze, belief, view):
    choose = gaze(mode="steps", **SWEEP)
    first = choose(belief(camera=view(2.0, 0.0)))
    turned = choose(belief(pose=(0.0, 0.0, -0.2), time=0.06, camera=view(2.0, 0.0)))
    assert turned.pan == pytest.approx(first.pan + 0.2)
