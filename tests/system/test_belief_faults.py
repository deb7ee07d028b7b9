"""Belief under faults of sensors and map."""

import numpy as np
import pytest

from navigation.angles import wrap

AROUND = "omnidirectional"  # sees the beacons wherever the gaze turns


def errors(recorded):
    """Return position [m] and heading [rad] error of every belief, and whether it is lost."""
    pairs = [(r.frame.belief, r.truth.robot) for r in recorded.records if r.frame is not None]
    position = np.array([np.hypot(*(b.pose - truth)[:2]) for b, truth in pairs])
    heading = np.array([abs(wrap(float(b.pose[2] - truth[2]))) for b, truth in pairs])
    assert np.isfinite(position).all()
    return position, heading, np.array([b.lost for b, _ in pairs])


def test_a_beacon_moved_by_half_a_metre_is_ignored(simulate):
    _, recorded, _ = simulate("quick", "world.beacon_displacement=0.5", camera=AROUND, duration=3.0)
    position, heading, lost = errors(recorded)
    assert any("yellow/cyan" in f.belief.seen_beacons for f in recorded.frames)
    assert not lost[-1]
    assert position[-1] < 0.05
    assert heading.max() < 0.05


def test_beacons_hold_the_heading_of_a_drifting_gyro(simulate):
    _, recorded, _ = simulate("quick", "sensors.gyro_bias=0.01", camera=AROUND, duration=5.0)
    position, heading, lost = errors(recorded)
    assert not (lost[1:] & lost[:-1]).any()  # beacons that contradict it relocalize it at once
    assert heading.max() < 0.04  # by itself it would be 0.05
    assert position.max() < 0.08


def test_without_beacons_the_robot_knows_its_way_by_what_stands_still(simulate):
    _, recorded, _ = simulate("quick", "world.beacons=false", duration=5.0)
    position, heading, lost = errors(recorded)
    assert not lost.any()
    assert position.max() < 0.08
    assert heading.max() < 0.05


def test_without_beacons_no_fault_of_the_camera_makes_it_believe_that_it_is_lost(simulate):
    faults = (
        '{kind="missed-detections",magnitude=0.2}',
        '{kind="false-detections",magnitude=0.5}',
        '{kind="camera-black",start=2.0,duration=1.0}',
    )
    _, recorded, _ = simulate(
        "quick", "world.beacons=false", f"fault=[{','.join(faults)}]", seed=1, duration=4.0
    )
    position, heading, lost = errors(recorded)
    assert not lost.any()
    assert position.max() < 0.1
    assert heading.max() < 0.1


@pytest.mark.gl
def test_a_biased_imu_leans_the_distances_but_loses_nobody(simulate):
    _, recorded, _ = simulate(
        "quick", "sensors.pitch_bias=0.0175", body="full", camera="rendered", duration=3.0
    )
    position, heading, _ = errors(recorded)
    assert position[-1] < 0.3
    assert heading.max() < 0.1
