from dataclasses import replace

import numpy as np
import pytest

from hsr8.measure.tracks import owners, track_metrics
from hsr8.recording.derived import truth_at
from navigation.belief.belief import Motion

DT = 0.06


@pytest.fixture
def measure(layout, fake, tables_of):
    """Results of tracks, given by frame."""

    def measured(*frames, disturbed=()):
        records = [
            fake.record(DT * k, frame=fake.frame(DT * k, tracks=tracks))
            for k, tracks in enumerate(frames)
        ]
        tables = tables_of(records)
        truth = truth_at(tables["frames"], tables["records"])
        undisturbed = ~np.isin(np.arange(len(frames)), disturbed)
        return track_metrics(tables["frames"], truth, layout, undisturbed)

    return measured


def test_without_frames_nothing_is_measured(measure):
    results = measure()
    assert results.pop("movers_recognised_after_s") == []
    assert set(results.values()) == {None}


def test_static_tracks_have_errors_and_consistency(measure, fake):
    """Covariance diag(4e-4, 1e-4): 2 cm along x and 2 cm along y off."""
    results = measure(
        [fake.track(0, 0.0, error=(0.02, 0.0))], [fake.track(0, DT, error=(0.0, 0.02))]
    )
    assert results["static_track_rmse_m"] == pytest.approx(0.02)
    assert results["static_track_nees_mean"] == pytest.approx((0.5 + 2.0) / 2)
    assert results["mover_track_rmse_m"] is None


def test_frames_after_a_contact_count_in_the_error_but_not_in_the_consistency(measure, fake):
    frames = [
        [fake.track(0, 0.0, error=(0.02, 0.0))],
        [fake.track(0, DT, error=(0.0, 0.02))],
        [fake.track(0, 2 * DT, error=(0.04, 0.0))],
    ]
    results = measure(*frames, disturbed=[1, 2])
    assert results["static_track_rmse_m"] == pytest.approx(np.sqrt((2 * 0.02**2 + 0.04**2) / 3))
    assert results["static_track_nees_mean"] == pytest.approx(0.5)


def test_a_mover_counts_after_a_second_in_view_if_recognised(measure, fake):
    def track(k):
        motion = Motion.MOVING if k >= 10 else Motion.UNKNOWN
        mover = fake.track(2, DT * k, velocity=(0.01, 0.1))
        return [replace(mover, visible=True, motion=motion)]

    assert measure(*map(track, range(17)))["mover_velocity_rmse_mps"] is None
    results = measure(*map(track, range(40)))
    assert results["mover_velocity_rmse_mps"] == pytest.approx(0.01)
    assert results["mover_velocity_nees_mean"] == pytest.approx(0.5)
    assert results["mover_track_rmse_m"] == pytest.approx(0.0, abs=1e-12)
    assert results["movers_recognised_after_s"] == [pytest.approx(10 * DT)]


def test_a_mover_out_of_view_does_not_count(measure, fake):
    tracks = [[replace(fake.track(2, DT * k), visible=False)] for k in range(40)]
    assert measure(*tracks)["mover_velocity_rmse_mps"] is None


@pytest.mark.parametrize(
    ("errors", "colors", "owned"),
    [
        ((0.04, 0.01), ("red", "red", "red"), {(1, 0), (0, 1)}),
        ((0.01, 0.04), ("red", "green", "red"), {(0, 0)}),
        ((), ("red", "red", "red"), set()),
    ],
)
def test_the_nearest_track_of_the_color_owns_an_obstacle(errors, colors, owned):
    """Two frames with tracks near the first two of three obstacles."""
    places = np.array([[[0.8, 0.6], [0.9, 0.6], [5.0, 5.0]]] * 2)
    n = len(errors)
    tracks = np.reshape([(0.8 + error, 0.6) for error in errors] * 2, (-1, 2))
    frames = np.repeat([0, 1], n)
    labels = np.full(2 * n, "red", dtype=object)
    pairs = zip(*owners(labels, tracks, frames, colors, places, scale=1.0), strict=True)
    assert set(pairs) == owned | {(k + n, i) for k, i in owned}
