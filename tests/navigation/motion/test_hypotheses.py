import numpy as np
import pytest

from compilation.record import record
from navigation.belief.belief import Motion
from navigation.belief.mode_filter import arc
from navigation.belief.tracks import Tracks
from navigation.motion.hypotheses import chord_velocity, collision_discs, within_reach
from navigation.parameters.motion import SafetyFilterParameters

P = SafetyFilterParameters()
SURE = 0.12 + 0.08 + 0.005 + P.margin
"""Collision distance of a track with a radius of 0.08 m and a sigma of 0.005 m [m]."""


def build(*tracks, p=P):
    obstacles = Tracks.of(tracks)
    discs = collision_discs(obstacles.rows, obstacles.clouds, 0.12, record(p))
    return discs.view(np.recarray)


def test_static_obstacles_have_a_short_horizon_and_no_sigma(track):
    h = build(track((1, 0), sigma=0.05))
    assert h.radius == pytest.approx([SURE])
    assert h.horizon.tolist() == [P.static_horizon]
    assert h.weight.tolist() == [1.0]


@pytest.mark.parametrize("point", [(0.0, 0.0), (0.1, 0.0)])
def test_uncertainty_of_the_radius_is_added(track, point):
    sure, unsure = (build(track((1, 0), point, radius_sigma=s)) for s in (0.005, 0.02))
    assert unsure.radius - sure.radius == pytest.approx(np.full(len(sure), 0.015))


def test_a_visible_mover_may_reverse(track):
    h = build(track((1, 0), (0.1, 0.0), sigma=0.05))
    assert h.velocity == pytest.approx(np.array([[0.1, 0.0], [-0.1, 0.0]]))
    assert h.weight == pytest.approx([1.0, P.reversal_weight])
    assert h.horizon == pytest.approx([P.moving_horizon, P.reversal_horizon])
    assert h.radius == pytest.approx(2 * [SURE + 0.05])


def test_the_undecided_keep_their_velocity_and_do_not_reverse(track):
    h = build(track((1, 0), (0.1, 0.0), Motion.UNKNOWN, sigma=1.0))
    assert len(h) == 1
    assert h.horizon.tolist() == [P.moving_horizon]
    assert h.radius == pytest.approx([SURE + P.max_sigma])


def test_a_lost_mover_is_its_particles(track):
    cloud = ([[1, 0], [2, 0]], [[0.1, 0], [-0.1, 0]], [0.25, 0.75])
    h = build(track((1.5, 0), (0.1, 0), age=3.0, particles=cloud), track((0, 1)))
    assert h.position.tolist() == [[0, 1], [1, 0], [2, 0]]
    assert h.weight == pytest.approx([1.0, 0.25 * P.particle_weight, 0.75 * P.particle_weight])


def test_a_turning_mover_follows_its_chord_and_reverses_on_its_circle(track):
    """A quarter circle in two seconds."""
    turn = 0.25 * np.pi
    h = build(track((1, 0), (0.1, 0.0), turn_rate=turn))
    chord = 0.1 * 2.0 * np.sqrt(2.0) / np.pi / np.sqrt(2.0) * np.array([1.0, 1.0])
    assert P.bend_time == 2.0
    assert h.velocity[0] == pytest.approx(chord)
    assert h.velocity[1] == pytest.approx(chord * (-1.0, 1.0))
    cloud = ([[1, 0]], [[0.1, 0]], [1.0])
    lost = track((1, 0), (0.1, 0), age=3.0, particles=cloud, turn_rates=[turn])
    assert build(lost).velocity[0] == pytest.approx(chord)


def test_only_discs_within_reach_are_kept(track):
    """Within their horizon at the speed of robot and mover together."""
    moving = (0.0, 0.1)
    reach = SURE + 0.01 + 0.3 * P.moving_horizon  # the position of a mover is uncertain
    h = build(
        track((SURE + 0.19 * P.static_horizon, 0)),
        track((SURE + 0.21 * P.static_horizon, 0)),
        track((0, reach - 0.01), moving),
        track((0, reach + 0.01), moving),
    )
    near = within_reach(h.view(np.ndarray), np.zeros(2), 0.2)
    assert near["position"].tolist() == [h.position[0].tolist(), h.position[2].tolist()]


@pytest.mark.parametrize("turn", [-1.3, 1e-5, 0.0, 0.4, np.pi])
def test_the_chord_is_the_mean_velocity_over_the_time(turn):
    """Against the midpoint rule, and against the arc that the filters of the tracks follow."""
    time, n = 2.0, 2000
    angles = turn * time * (np.arange(n) + 0.5) / n
    c, s = np.cos(angles).mean(), np.sin(angles).mean()
    chord = chord_velocity(0.03, -0.04, turn, time)
    assert chord == pytest.approx((0.03 * c + 0.04 * s, 0.03 * s - 0.04 * c), abs=1e-7)
    along, across, *_ = arc(turn, time)
    expected = (0.03 * along + 0.04 * across, 0.03 * across - 0.04 * along)
    assert chord == pytest.approx(expected, abs=1e-12)
