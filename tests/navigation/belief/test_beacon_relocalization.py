import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navigation.belief.beacon_relocalization import BeaconRelocalization
from navigation.parameters.belief import LocalizationParameters

P = LocalizationParameters()
BEACONS = {"a": (2.0, 0.5), "b": (0.0, 2.2), "c": (-2.0, -0.5), "d": (0.4, -2.0)}
poses = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-3.0, 3.0))


def made():
    return BeaconRelocalization(P, BEACONS)


def saw(relocalization, frame, observe, pose, odometry, names, time=0.0, moved=()):
    """Beacons seen from a true pose, remembered where odometry has them."""
    positions = BEACONS | dict(moved)
    observed = [observe(pose, positions[name], kind="beacon", label=name) for name in names]
    taken = frame(time, odometry, observed)
    for observation in observed:
        relocalization.remember(observation, taken)
    return taken


@given(pose=poses, odometry=poses)
def test_two_beacons_determine_the_pose_for_any_odometry(frame, observe, pose, odometry):
    lost = made()
    taken = saw(lost, frame, observe, pose, odometry, "ab")
    result = lost.locate(taken, np.zeros(3))
    assert result is not None
    assert np.allclose(result[:2], pose[:2], atol=1e-9)
    assert np.cos(result[2] - pose[2]) == pytest.approx(1.0)


def test_beacons_seen_one_after_the_other_while_turning_count_together(frame, observe):
    lost = made()
    saw(lost, frame, observe, (0.3, 0.2, 0.0), (1.0, 1.0, 2.0), "a", time=0.0)
    taken = saw(lost, frame, observe, (0.3, 0.2, 1.5), (1.0, 1.0, 3.5), "b", time=2.0)
    result = lost.locate(taken, np.zeros(3))
    assert np.allclose(result, (0.3, 0.2, 1.5))


def test_one_beacon_or_one_too_old_is_not_enough(frame, observe):
    lost = made()
    first = saw(lost, frame, observe, (0, 0, 0), (0, 0, 0), "a")
    assert lost.locate(first, np.zeros(3)) is None
    late = P.recovery_window + 0.1
    second = saw(lost, frame, observe, (0, 0, 0), (0, 0, 0), "b", time=late)
    assert lost.locate(second, np.zeros(3)) is None


def test_the_one_that_was_moved_is_left_out_if_the_rest_agree_with_the_belief(frame, observe):
    lost = made()
    pose = (0.2, -0.3, 0.4)
    taken = saw(lost, frame, observe, pose, (0, 0, 0), "abcd", moved={"c": (-1.0, 1.0)})
    result = lost.locate(taken, np.array(pose))
    assert np.allclose(result, pose)
    assert lost.displaced == {"c"}
    far = made()
    taken = saw(far, frame, observe, pose, (0, 0, 0), "abcd", moved={"c": (-1.0, 1.0)})
    assert far.locate(taken, np.array([1.5, 1.5, 0.0])) is None
    assert not far.displaced


def test_a_run_of_rejections_of_several_beacons_means_lost():
    detector = made()
    verdicts = [detector.is_lost(0.06 * k, [], ["ab"[k % 2]]) for k in range(P.lost_rejections)]
    assert verdicts == [False] * (P.lost_rejections - 1) + [True]


def test_rejections_of_a_single_beacon_mean_lost_after_a_while_alone():
    detector, step = made(), 0.06
    verdicts = [detector.is_lost(step * k, [], ["a"]) for k in range(100)]
    assert verdicts.index(True) * step == pytest.approx(P.lost_time, abs=2 * step)


def test_a_beacon_contradicted_by_others_again_and_again_was_moved():
    detector = made()
    for k in range(P.displaced_rejections - 1):
        detector.is_lost(0.06 * k, ["a"], ["b"])
    assert not detector.displaced
    detector.is_lost(1.0, ["a"], ["b"])
    assert detector.displaced == {"b"}


def test_an_outlier_is_forgiven_by_the_next_sighting_that_fits():
    detector = made()
    for k in range(3 * P.displaced_rejections):
        accepted, rejected = (["a", "b"], []) if k % 3 == 2 else (["a"], ["b"])
        detector.is_lost(0.06 * k, accepted, rejected)
    assert not detector.displaced
