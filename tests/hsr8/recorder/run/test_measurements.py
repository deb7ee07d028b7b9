from dataclasses import astuple, replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hsr8.recorder.fingerprints import decision_fingerprints, fingerprints
from hsr8.recorder.run.measurements import MeasurementWriter, read_measurements
from navigation.observation import Observation

finite = st.floats(allow_nan=False, allow_infinity=False, width=64)


@given(
    numbers=st.lists(finite, min_size=10, max_size=10),
    label=st.text(min_size=1, max_size=12),
    flags=st.tuples(st.booleans(), st.booleans(), st.booleans()),
)
def test_round_trip_is_exact(tmp_path_factory, fake, numbers, label, flags):
    beacon, cut, occluded = flags
    observation = Observation(
        "beacon" if beacon else "obstacle",
        label,
        *numbers[:2],
        np.array(numbers[2:6]).reshape(2, 2),
        *numbers[6:8],
        cut,
        occluded,
        np.array(numbers[8:]),
    )
    file = tmp_path_factory.mktemp("m") / "m"
    frame = fake.frame(0.06, (0.1, 0.2, 0.3))
    frame = replace(frame, measured=replace(frame.measured, observations=(observation,)))
    writer = MeasurementWriter(file)
    writer.add(frame)
    writer.close()
    (back,) = read_measurements(file, whole=True)
    a, b = back.frame, frame.measured
    assert a.time == b.time
    for name in ("odometry", "motion_covariance"):
        assert np.array_equal(getattr(a, name), getattr(b, name))
    assert np.array_equal(a.view.rotation, b.view.rotation)
    assert np.array_equal(a.view.position, b.view.position)
    assert (a.view.pan, a.view.tilt, a.view.yaw_sigma) == (b.view.pan, b.view.tilt, 0.0)
    (back_observation,) = a.observations
    assert np.array_equal(back_observation.covariance, observation.covariance)
    assert np.array_equal(back_observation.by_radius, observation.by_radius)
    numbers = [replace(o, covariance=None, by_radius=None) for o in (back_observation, observation)]
    assert astuple(numbers[0]) == astuple(numbers[1])
    assert back.fingerprints == fingerprints(frame.estimate)
    assert back.decision == decision_fingerprints(frame.decision)
    assert back.context.time == frame.context.time
    assert back.context.step_count == frame.context.step_count
    assert np.array_equal(back.context.odometry, frame.context.odometry)
    assert np.array_equal(back.context.view.rotation, frame.context.view.rotation)
    assert back.fresh == frame.decision.fresh
