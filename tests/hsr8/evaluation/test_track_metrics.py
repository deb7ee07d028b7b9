from dataclasses import replace

import numpy as np
import pytest

from hsr8.evaluation.track_metrics import TrackMetrics, owners
from navigation.belief.belief import Motion

DT = 0.06


@pytest.fixture
def metrics(layout):
    return TrackMetrics(layout.obstacles)


def show(metrics, fake, time, *tracks):
    record = fake.record(time, frame=fake.frame(time, tracks=tracks))
    metrics.add(record.frame, record.truth)


def test_without_frames_nothing_is_measured(metrics):
    results = metrics.result()
    assert results.pop("movers_recognised_after_s") == []
    assert set(results.values()) == {None}


def test_static_tracks_have_errors_and_consistency(metrics, fake):
    """Covariance diag(4e-4, 1e-4): 2 cm along x and 2 cm along y off."""
    show(metrics, fake, 0.0, fake.track(0, 0.0, error=(0.02, 0.0)))
    show(metrics, fake, DT, fake.track(0, DT, error=(0.0, 0.02)))
    results = metrics.result()
    assert results["static_track_rmse_m"] == pytest.approx(0.02)
    assert results["static_track_nees_mean"] == pytest.approx((0.5 + 2.0) / 2)
    assert results["mover_track_rmse_m"] is None


def test_a_mover_counts_after_a_second_in_view_if_recognised(metrics, fake):
    for k in range(40):
        time = DT * k
        motion = Motion.MOVING if k >= 10 else Motion.UNKNOWN
        track = replace(fake.track(2, time, velocity=(0.01, 0.1)), visible=True, motion=motion)
        show(metrics, fake, time, track)
        if k == 16:
            assert metrics.result()["mover_velocity_rmse_mps"] is None
    results = metrics.result()
    assert results["mover_velocity_rmse_mps"] == pytest.approx(0.01)
    assert results["mover_velocity_nees_mean"] == pytest.approx(0.5)
    assert results["mover_track_rmse_m"] == pytest.approx(0.0, abs=1e-12)
    assert results["movers_recognised_after_s"] == [pytest.approx(10 * DT)]


def test_a_mover_out_of_view_does_not_count(metrics, fake):
    for k in range(40):
        show(metrics, fake, DT * k, replace(fake.track(2, DT * k), visible=False))
    assert metrics.result()["mover_velocity_rmse_mps"] is None


def test_the_nearest_track_of_the_color_owns_an_obstacle(fake):
    places = np.array([[0.8, 0.6], [0.9, 0.6], [5.0, 5.0]])
    a, b = fake.track(0, 0.0, error=(0.01, 0.0)), fake.track(0, 0.0, error=(0.04, 0.0))
    assert owners([b, a], ["red", "red", "red"], places) == {0: a, 1: b}
    assert owners([a, b], ["red", "green", "red"], places) == {0: a}
    assert owners([], ["red", "red", "red"], places) == {}
