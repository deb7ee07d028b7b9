import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.scenario.fault import CameraDrops, CameraLatency
from hsr8.scenario.sensors import Camera
from hsr8.world.camera.feed import CameraFaults, CameraFeed, CapturedFrame


def deliveries(ticks=400, seed=0, faults=(), **settings):
    """Tick and capture time [s] of every frame that arrives."""
    feed = CameraFeed(
        Camera(**settings),
        np.random.default_rng(seed),
        CameraFaults(faults),
    )
    arrived = []
    for tick in range(ticks):
        frame = feed.arrived(tick, lambda tick=tick: CapturedFrame(0.005 * tick))
        if frame is not None:
            arrived.append((tick, frame.captured))
    return arrived


@settings(max_examples=25)
@given(
    latency=st.integers(0, 100).map(lambda k: 5 * k), period=st.integers(1, 30).map(lambda k: 5 * k)
)
def test_frames_arrive_in_order_each_after_the_latency(latency, period):
    arrived = deliveries(latency_ms=latency, period_ms=period)
    captured = [time for _, time in arrived]
    assert captured == sorted(captured)
    assert captured[0] == 0.0
    assert np.allclose(np.diff(captured), period / 1000)
    for tick, time in arrived:
        assert 0.005 * tick == pytest.approx(time + latency / 1000)


def test_dropped_frames_never_arrive_and_the_others_are_not_moved():
    every = set(deliveries(4000, latency_ms=60))
    some = set(
        deliveries(4000, latency_ms=60, faults=[CameraDrops(kind="camera-drops", magnitude=0.3)])
    )
    assert some < every
    assert len(some) == pytest.approx(0.7 * len(every), rel=0.1)
    assert deliveries(faults=[CameraDrops(kind="camera-drops", magnitude=1.0)]) == []


@settings(max_examples=25)
@given(
    late=st.integers(0, 60),
    usual=st.integers(0, 20),
    period=st.integers(1, 20),
    start=st.integers(0, 100),
    lasts=st.integers(1, 100),
)
def test_late_frames_come_in_order_a_period_apart_and_none_but_late_ones_are_lost(
    late, usual, period, start, lasts
):
    times = {"start": 0.005 * start, "duration": 0.005 * lasts}
    fault = CameraLatency(kind="camera-latency", magnitude=0.005 * late, **times)
    arrived = deliveries(ticks=400, faults=[fault], latency_ms=5 * usual, period_ms=5 * period)
    captured = [round(time / 0.005) for _, time in arrived]
    assert all(np.diff(captured) >= period)
    assert all(np.diff([tick for tick, _ in arrived]) >= period)
    for tick, taken in zip([tick for tick, _ in arrived], captured, strict=True):
        whole = -(-late // period) * period
        assert tick - taken == usual + whole * (start <= taken < start + lasts)
    punctual = [k for k in range(0, 400 - usual, period) if not start <= k < start + lasts]
    assert set(punctual) <= set(captured)
