from dataclasses import replace
from math import pi, tan

import numpy as np
import pytest

from navigation.belief.visibility import (
    FREE,
    OCCUPIED,
    UNSEEN,
    Viewpoint,
    clear_points,
    observed_cells,
)
from navigation.observation import shadow_at
from navigation.transform import yaw_rotation

RANGE = 2.5
NOTHING = np.empty((0, 2)), np.empty(0)


def contains(viewpoint, points):
    return clear_points(points, *viewpoint, *NOTHING)


def test_an_omnidirectional_camera_contains_everything_in_range(view):
    rng = np.random.default_rng(2)
    points = rng.uniform(-3.0, 3.0, (50, 2))
    wide = view(0.4, -0.3, hfov=2.0 * np.pi, vfov=np.pi)
    observed = contains(Viewpoint.of(wide, np.array([0.3, -0.2, 1.0]), 1.5, 0.1), points)
    np.testing.assert_array_equal(observed, np.hypot(*(points - [0.3, -0.2]).T) <= 1.5)


def test_a_panoramic_camera_contains_a_sector(view):
    sector = Viewpoint.of(view(pan=0.3, hfov=4.0, vfov=pi), np.array([0.0, 0.0, 0.5]), 9.0)
    angles = np.linspace(-pi, pi, 721)
    points = 1.5 * np.column_stack([np.cos(angles), np.sin(angles)])
    offset = np.abs(np.angle(np.exp(1j * (angles - 0.8))))
    assert np.array_equal(contains(sector, points), offset < 2.0)


@pytest.fixture
def scene(view):
    """Points, camera in R, its pose in W, discs."""

    def drawn(seed):
        rng = np.random.default_rng(seed)
        shadow = rng.uniform(0.0, 1.5, 36)
        camera = view(pan=rng.uniform(-1, 1), tilt=-0.6, hfov=1.5, vfov=0.8)
        camera = replace(camera, model=replace(camera.model, top=0.5, min_top=0.3, shadow=shadow))
        pose = rng.uniform(-1, 1, 3)
        points = rng.uniform(-3, 3, (200, 2))
        centres, radii = rng.uniform(-2, 2, (20, 2)), rng.uniform(0.05, 0.2, 20)
        return points, (camera, pose), centres, radii

    return drawn


def eye(camera, pose):
    """Return the position of a camera in W."""
    return yaw_rotation(pose[2]) @ camera.position + (*pose[:2], 0.0)


def contained(points, camera, pose, margin):
    position, sight = eye(camera, pose), camera.model
    offset = points - position[:2]
    distance = np.hypot(offset[:, 0], offset[:, 1])
    bearing = np.arctan2(offset[:, 1], offset[:, 0]) - pose[2]
    foot = distance >= np.array([shadow_at(b, sight.shadow) for b in bearing])
    foot &= shown(offset, -position[2], camera, pose, margin)
    top = shown(offset, sight.min_top - position[2], camera, pose, margin)
    return (distance <= RANGE) & (foot | top)


def shown(offset, up, camera, pose, margin):
    d = np.column_stack([offset, np.full(len(offset), up)])
    right, down, forward = (d @ (yaw_rotation(pose[2]) @ camera.rotation)).T
    inside = np.abs(right) <= tan(0.5 * camera.horizontal_fov - margin) * forward
    inside &= np.abs(down) <= tan(0.5 * camera.vertical_fov - margin) * forward
    return inside & (forward > 0.0)


def blocked(points, camera, pose, centres, radii, slack):
    origin = eye(camera, pose)[:2]
    p, a = points[:, None] - origin, centres - origin
    along = np.sum(p * a, axis=2)
    across = p[..., 0] * a[:, 1] - p[..., 1] * a[:, 0]
    nearer = along > np.sum(a * a, axis=1)
    return (nearer & (np.abs(across) < (radii + slack) * np.hypot(*p.T).T)).any(axis=1)


@pytest.mark.parametrize("seed", range(2))
def test_points_agree_with_the_formulas_over_arrays(scene, seed):
    points, view, centres, radii = scene(seed)
    inside, behind = contained(points, *view, 0.05), blocked(points, *view, centres, radii, 0.03)
    clear = clear_points(points, *Viewpoint.of(*view, RANGE, 0.05), centres, radii, 0.03)
    assert np.array_equal(clear, inside & ~behind)
    assert 0 < clear.sum() < inside.sum()


@pytest.mark.parametrize("seed", range(2))
def test_cells_agree_with_the_formulas_over_arrays(scene, seed):
    _, view, centres, radii = scene(seed)
    corner, cell, count = (-20, -17), 0.1, 40
    v, first = Viewpoint.of(*view, RANGE), np.array(corner, float)
    marks = observed_cells(first, cell, count, v.eye, v.shadow, centres, radii)
    x, y = (cell * (first + np.arange(count) + 0.5) for first in corner)
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    apart = np.hypot(*(points[:, None] - centres).transpose(2, 0, 1))
    on = (apart < radii + 0.5 * cell).any(axis=1)
    observed = np.where(blocked(points, *view, centres, radii, 0.0), UNSEEN, FREE)
    wanted = contained(points, *view, 0.0) * np.where(on, OCCUPIED, observed)
    assert np.array_equal(marks.ravel(), wanted)
    assert set(wanted.tolist()) == {UNSEEN, FREE, OCCUPIED}
