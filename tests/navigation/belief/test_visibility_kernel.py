"""Compiled against plain Python bit for bit, and against formulas over whole arrays."""

from dataclasses import replace
from math import tan

import numpy as np
import pytest

from navigation.belief import visibility_kernel as kernel
from navigation.belief.visibility import Viewpoint
from navigation.observation import Sight, shadow_at


@pytest.fixture
def scene(view):
    """Points, viewpoint, its camera array, discs."""

    def drawn(seed, *, wide=False):
        rng = np.random.default_rng(seed)
        sight = Sight(0.3, rng.uniform(0.0, 1.5, 36))
        camera = view(pan=rng.uniform(-1, 1), tilt=-0.6, hfov=7.0 if wide else 1.5, vfov=0.8)
        camera = replace(camera, sight=sight)
        viewpoint = Viewpoint.of(camera, rng.uniform(-1, 1, 3), 2.5)
        points = rng.uniform(-3, 3, (200, 2))
        centres, radii = rng.uniform(-2, 2, (20, 2)), rng.uniform(0.05, 0.2, 20)
        return points, viewpoint, (viewpoint._camera(0.05), sight.shadow), centres, radii

    return drawn


def contained(points, v, margin):
    offset = points - v.position[:2]
    distance = np.hypot(offset[:, 0], offset[:, 1])
    bearing = np.arctan2(offset[:, 1], offset[:, 0]) - v.heading
    foot = distance >= np.array([shadow_at(b, v.sight.shadow) for b in bearing])
    foot &= shown(offset, -v.position[2], v, margin)
    return (distance <= v.range) & (foot | shown(offset, v.sight.top - v.position[2], v, margin))


def shown(offset, up, v, margin):
    d = np.column_stack([offset, np.full(len(offset), up)])
    right, down, forward = (d @ v.rotation).T
    inside = np.abs(right) <= tan(v.horizontal_half - margin) * forward
    inside &= np.abs(down) <= tan(v.vertical_half - margin) * forward
    return inside & (forward > 0.0)


def hidden(points, v, centres, radii, slack):
    p, a = points[:, None] - v.position[:2], centres - v.position[:2]
    along = np.sum(p * a, axis=2)
    across = p[..., 0] * a[:, 1] - p[..., 1] * a[:, 0]
    nearer = along > np.sum(a * a, axis=1)
    return (nearer & (np.abs(across) < (radii + slack) * np.hypot(*p.T).T)).any(axis=1)


@pytest.mark.parametrize("wide", [False, True])
def test_compiled_and_plain_agree(scene, wide):
    points, v, camera, centres, radii = scene(0, wide=wide)
    for function, arguments in (
        (kernel.in_clear_view, (points, v.position, *camera, centres, radii, 0.05)),
        (
            kernel.observed_cells,
            (np.array([-9.0, -8.0]), 0.15, 16, v.position, *camera, centres, radii),
        ),
    ):
        assert np.array_equal(function(*arguments), function.py_func(*arguments))


@pytest.mark.parametrize("seed", range(4))
def test_points_agree_with_the_formulas_over_arrays(scene, seed):
    points, v, camera, centres, radii = scene(seed)
    inside, blocked = contained(points, v, 0.05), hidden(points, v, centres, radii, 0.03)
    clear = kernel.in_clear_view(points, v.position, *camera, centres, radii, 0.03)
    assert np.array_equal(clear, inside & ~blocked)
    assert 0 < clear.sum() < inside.sum()


@pytest.mark.parametrize("seed", range(4))
def test_cells_agree_with_the_formulas_over_arrays(scene, seed):
    _, v, _, centres, radii = scene(seed)
    corner, cell, count = (-20, -17), 0.1, 40
    marks = v.observed_cells(corner, cell, count, centres, radii)
    x, y = (cell * (first + np.arange(count) + 0.5) for first in corner)
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    apart = np.hypot(*(points[:, None] - centres).transpose(2, 0, 1))
    on = (apart < radii + 0.5 * cell).any(axis=1)
    observed = np.where(hidden(points, v, centres, radii, 0.0), kernel.UNSEEN, kernel.FREE)
    wanted = contained(points, v, 0.0) * np.where(on, kernel.OCCUPIED, observed)
    assert np.array_equal(marks.ravel(), wanted)
    assert set(wanted.tolist()) == {kernel.UNSEEN, kernel.FREE, kernel.OCCUPIED}


def test_a_look_is_written_alike_by_compiled_and_plain_code():
    rng = np.random.default_rng(6)
    marks = rng.integers(0, 3, (20, 20)).astype(np.uint8)
    maps = []
    for write in (kernel.update_grid, kernel.update_grid.py_func):
        seen_at, log_odds = np.zeros((20, 20)), np.linspace(-4, 4, 400).reshape(20, 20)
        write(marks, seen_at, log_odds, 3.0, (-0.4, 1.0, 4.0))
        maps.append((seen_at, log_odds))
    assert np.array_equal(maps[0], maps[1])
    change = np.array([0.0, -0.4, 1.0])[marks]
    before = np.linspace(-4, 4, 400).reshape(20, 20)
    assert np.array_equal(maps[0][1], np.clip(before + change, -4.0, 4.0))
    assert np.array_equal(maps[0][0], 3.0 * (marks > 0))
