from math import cos, hypot, pi, sin

import numpy as np
import pytest

from navigation.baselines.half_planes import HalfPlane, orca_plane, solve
from navigation.parameters.planner import OrcaParameters

V_MAX = 0.2


def plane_at(angle, offset):
    """Allowed: v . n <= offset for the normal n at `angle`."""
    n = (cos(angle), sin(angle))
    return HalfPlane(offset * n[0], offset * n[1], -n[1], n[0])


def lattice():
    axis = np.linspace(-V_MAX, V_MAX, 161)
    grid = np.stack(np.meshgrid(axis, axis), -1).reshape(-1, 2)
    return grid[np.hypot(grid[:, 0], grid[:, 1]) <= V_MAX]


def depths(planes, v):
    return np.array([p.dx * (p.y - v[..., 1]) - p.dy * (p.x - v[..., 0]) for p in planes])


def random_planes(rng, low):
    n = rng.integers(1, 7)
    return [plane_at(rng.uniform(-pi, pi), rng.uniform(low, 0.15)) for _ in range(n)]


def test_the_program_finds_the_nearest_allowed_velocity():
    rng, grid = np.random.default_rng(0), lattice()
    for _ in range(60):
        planes = random_planes(rng, 0.0)
        desired = rng.uniform(-0.25, 0.25, 2)
        v = solve(planes, 0, (desired[0], desired[1]), V_MAX)
        assert max(p.depth(v) for p in planes) < 1e-9
        assert hypot(*v) <= V_MAX + 1e-9
        allowed = grid[(depths(planes, grid) <= 0.0).all(axis=0)]
        best = np.hypot(*(allowed - desired).T).min()
        assert hypot(v[0] - desired[0], v[1] - desired[1]) <= best + 1e-9


def test_without_a_solution_the_largest_violation_is_least():
    rng, grid = np.random.default_rng(1), lattice()
    tried = 0
    for _ in range(80):
        planes = random_planes(rng, -0.15)
        least = depths(planes, grid).max(axis=0).min()
        if least <= 0.004:
            continue
        tried += 1
        v = solve(planes, 0, (0.1, 0.0), V_MAX)
        assert max(p.depth(v) for p in planes) <= least + 1e-6
    assert tried > 15


def test_hard_half_planes_hold_whatever_the_others_ask():
    rng = np.random.default_rng(2)
    box = [plane_at(k * pi / 2, 0.05) for k in range(4)]
    for _ in range(60):
        planes = [*box, *random_planes(rng, -0.15)]
        v = solve(planes, 4, tuple(rng.uniform(-0.2, 0.2, 2)), V_MAX)
        assert max(p.depth(v) for p in box) < 1e-6


def touches(position, relative, radius, horizon):
    """Whether a robot with this relative velocity touches the disc in time."""
    when = np.linspace(0.0, horizon, 4000)[:, None]
    return bool((np.hypot(*(when * relative - position).T) < radius).any())


def test_the_boundary_with_full_responsibility_just_touches():
    rng = np.random.default_rng(3)
    for _ in range(40):
        angle, distance = rng.uniform(-pi, pi), rng.uniform(0.35, 1.2)
        position = distance * np.array([cos(angle), sin(angle)])
        own, other = rng.uniform(-0.2, 0.2, 2), rng.uniform(-0.1, 0.1, 2)
        p = orca_plane(
            tuple(position), tuple(own - other), tuple(own),
            radius=0.28, horizon=5.0, footstep=0.34, responsibility=1.0,
        )  # fmt: skip
        point, out = np.array([p.x, p.y]), np.array([-p.dy, p.dx])
        assert not touches(position, point + 1e-3 * out - other, 0.28, 5.0)
        assert touches(position, point - 1e-3 * out - other, 0.28, 5.0)


def test_half_the_responsibility_takes_half_the_way():
    given = {"radius": 0.28, "horizon": 5.0, "footstep": 0.34}
    own = (0.18, 0.02)
    full, half = (orca_plane((0.7, 0.05), own, own, responsibility=r, **given) for r in (1.0, 0.5))
    assert (half.dx, half.dy) == (full.dx, full.dy)
    assert 2.0 * half.x - own[0] == pytest.approx(full.x)
    assert 2.0 * half.y - own[1] == pytest.approx(full.y)


def test_an_overlap_is_left_within_a_footstep():
    p = orca_plane(
        (0.2, 0.0), (0.0, 0.0), (0.0, 0.0),
        radius=0.25, horizon=5.0, footstep=0.34, responsibility=1.0,
    )  # fmt: skip
    v = solve([p], 0, (0.1, 0.0), 1.0)
    assert 0.2 - 0.34 * v[0] >= 0.25 - 1e-9


@pytest.mark.parametrize("position", [(0.0, 0.0), (0.2, 0.0), (-0.03, 0.04), (0.0, -0.2)])
@pytest.mark.parametrize("factor", [1.0, 1.0 - 1e-12, 0.0])
def test_at_an_overlap_the_normal_has_unit_length_whatever_the_velocity(position, factor):
    """Also if the relative velocity ends the overlap exactly: the disc is then on the centre."""
    relative = factor * position[0] / 0.34, factor * position[1] / 0.34
    p = orca_plane(
        position, relative, (0.0, 0.0),
        radius=0.25, horizon=5.0, footstep=0.34, responsibility=1.0,
    )  # fmt: skip
    assert hypot(p.dx, p.dy) == pytest.approx(1.0)
    distance = hypot(position[0], position[1])
    if factor and distance > 0.0:
        assert (-p.dy * position[0] + p.dx * position[1]) / distance == pytest.approx(-1.0)


def test_movers_have_a_longer_horizon_than_static_obstacles(plan, belief, task, track, limits):
    p = OrcaParameters()
    gap = 0.5 * (p.static_horizon + p.horizon) * limits.vx
    position = (gap + 0.2 + p.margin, 0.0)
    free, static, moving = (
        plan("orca", belief(tracks), task((4.0, 0.0))).velocity
        for tracks in ([], [track(position)], [track(position, (-0.1, 0.0))])
    )
    assert static == pytest.approx(free)
    assert not np.allclose(moving, free)
