import numpy as np
import pytest

from navigation.belief.tracks import Tracks
from navigation.parameters.gaze import EvaluationParameters
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import (
    SamplePoints,
    attended,
    obstacle_free_distance,
    psi_local_map,
    psi_obstacle,
    psi_self,
    psi_way,
)

E = EvaluationParameters()
PRINTED = NavigationParameters.paper().evaluation
HERE, STILL = np.zeros(2), np.zeros(2)


def test_sample_points_fill_the_printed_ring():
    s = SamplePoints.polar(E, np.pi / 2)
    assert len(s.distance) == 114
    assert s.distance.min() == pytest.approx(0.30)
    assert s.distance.max() == pytest.approx(1.30)
    assert np.abs(s.bearing).max() == pytest.approx(np.pi / 2)
    assert np.hypot(*s.points.T) == pytest.approx(s.distance)


def test_psi_lm_is_0_when_all_is_confident_and_1_when_nothing_is():
    outside = np.zeros(114, bool)
    assert psi_local_map(np.ones(114), outside, E).psi == 0.0
    assert psi_local_map(np.zeros(114), outside, E).psi == 1.0
    assert psi_local_map(np.zeros(114), ~outside, E).psi == 0.0


def test_psi_lm_grows_with_the_under_confident_points():
    outside = np.zeros(114, bool)
    values = [psi_local_map(np.arange(114) >= n, outside, E).psi for n in range(115)]
    assert np.all(np.diff(values) >= 0.0)
    assert values[38] == pytest.approx(0.5)
    assert values[57] == pytest.approx(1.0)


def test_only_points_below_the_threshold_and_outside_the_gaze_region_count():
    threshold = np.array([E.lambda_cf, E.lambda_cf - 1e-9])
    assert psi_local_map(threshold, np.zeros(2, bool), E).under_confident.tolist() == [False, True]
    m = psi_local_map(np.zeros(4), np.array([True, False, False, True]), E)
    assert m.under_confident.tolist() == [False, True, True, False]
    assert m.counted.sum() == 2


def covariance(sigma, turn=0.0, angle=0.0):
    c, s = np.cos(angle), np.sin(angle)
    p = np.zeros((3, 3))
    r = np.array([[c, -s], [s, c]])
    p[:2, :2] = r @ np.diag([sigma**2, 0.0]) @ r.T
    p[2, 2] = turn**2
    return p


def test_psi_sf_is_the_ratio_to_its_threshold():
    assert psi_self(covariance(0.0), E) == 0.0
    assert psi_self(covariance(E.t_sf), E) == pytest.approx(1.0)
    assert psi_self(covariance(2 * E.t_sf), E) == 1.0
    assert psi_self(covariance(0.4 * E.t_sf), E) == pytest.approx(0.4)
    assert psi_self(covariance(0.4 * E.t_sf, angle=1.1), E) == pytest.approx(0.4)
    for position in (0.3, 0.7):
        P = covariance(position * E.t_sf, turn=0.6 * E.t_heading)
        assert psi_self(P, E) == pytest.approx(max(position, 0.6))


def test_psi_sf_includes_the_heading_in_extended_only():
    assert psi_self(covariance(0.0, turn=E.t_heading), E) == pytest.approx(1.0)
    assert psi_self(covariance(0.0, turn=E.t_heading), PRINTED) == 0.0


def test_psi_ob_scales_with_sigma_and_inverse_distance(track):
    def psi(distance, sigma):
        o = Tracks.of([track((distance, 0), (0.05, 0), sigma=sigma)])
        return psi_obstacle(o, HERE, STILL, E)[0]

    assert psi(1.0, 0.01) == pytest.approx(20 * 0.01 * 0.05 / 0.25)
    assert psi(2.0, 0.01) == pytest.approx(0.5 * psi(1.0, 0.01))
    assert psi(2.0, 0.03) == pytest.approx(3.0 * psi(2.0, 0.01))
    assert psi(0.0, 10.0) == 1.0


def test_psi_ob_depends_on_relative_speed(track):
    o = Tracks.of([track((1, 0), (0.1, 0)), track((1, 0))])
    assert psi_obstacle(o, HERE, np.array([0.1, 0.0]), E)[0] == 0.0
    assert psi_obstacle(o, HERE, np.array([0.1, 0.0]), E)[1] > 0.0
    mirrored = Tracks.of([track((1, 0.5), (0.1, 0.1)), track((1, -0.5), (0.1, -0.1))])
    left, right = psi_obstacle(mirrored, HERE, STILL, E)
    assert left == pytest.approx(right)


def test_free_distance_ends_at_the_nearest_shape():
    centres, radii = np.array([[1.0, 0.0], [0.0, 0.5]]), np.array([0.2, 0.2])
    assert obstacle_free_distance(HERE, centres, radii, 0.8) == pytest.approx(0.3)
    assert obstacle_free_distance(HERE, np.zeros((0, 2)), np.zeros(0), 0.8) == 0.8
    assert obstacle_free_distance(np.array([0.0, 0.4]), centres, radii, 0.8) == 0.0
    ratios = [psi_way(f * E.d_n_thres, E) for f in (-1.0, 0.0, 0.25, 1.0, 2.0)]
    assert ratios == pytest.approx([0.0, 0.0, 0.25, 1.0, 1.0])


def test_psi_way_is_lipschitz():
    rng = np.random.default_rng(1)
    centres, radii = rng.uniform(-1, 1, (5, 2)), rng.uniform(0.1, 0.3, 5)
    for _ in range(200):
        a = rng.uniform(-1.5, 1.5, 2)
        b = a + rng.normal(0, 0.1, 2)
        pa, pb = (
            psi_way(obstacle_free_distance(x, centres, radii, E.d_n_thres), E) for x in (a, b)
        )
        assert abs(pa - pb) <= np.hypot(*(a - b)) / E.d_n_thres + 1e-12


def test_the_set_o_is_frontal_or_closing(track):
    def member(degrees, speed=0.0, distance=1.0):
        a = np.radians(degrees)
        outward = np.array([np.cos(a), np.sin(a)])
        o = Tracks.of([track(distance * outward, speed * outward)])
        return bool(attended(o.rows, np.zeros(3), STILL, 2.0)[0])

    assert [member(d) for d in (85, 95, -85, -95, 170)] == [True, False, True, False, False]
    assert member(170, -0.1)
    assert not member(0, distance=2.1)
    abeam = Tracks.of([track((0, 1))])
    assert not attended(abeam.rows, np.zeros(3), STILL, 2.0)[0]
    assert not member(170, 0.1)
    walking = np.array([0.1, 0.0])
    for speed, closing in ((0.15, True), (0.05, False), (0.0, False)):
        o = Tracks.of([track((-1, 0), (speed, 0))])
        assert attended(o.rows, np.zeros(3), walking, 2.0)[0] == closing
