"""Inputs: each message type gives its command, and any other bytes are refused."""

from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("rosbags")
from hsr8.export.bag import require_rosbags
from hsr8.ros.inputs import INPUTS, MAX_NUMBER

_, MESSAGES = require_rosbags()
TWIST, STAMPED, STATE, TRAJECTORY = INPUTS
JOINTS = ("head_pan", "head_tilt")
numbers = st.floats(-MAX_NUMBER, MAX_NUMBER)


def read(source, contents):
    return source.read(MESSAGES.store, MESSAGES.one(source.kind, contents), JOINTS)


@given(numbers, numbers, numbers)
def test_velocities(vx, vy, wz):
    twist = {"linear": {"x": vx, "y": vy}, "angular": {"z": wz}}
    assert read(TWIST, twist) == read(STAMPED, {"twist": twist}) == (vx, vy, wz)


@given(numbers, numbers)
def test_angles_of_the_joints_of_the_robot(pan, tilt):
    names, angles = ["wheel", *JOINTS], [0.0, pan, tilt]
    expected = {"head_pan": pan, "head_tilt": tilt}
    assert read(STATE, {"name": names, "position": angles}) == expected
    points = [{"positions": [0.0, 0.0, 0.0]}, {"positions": angles}]
    assert read(TRAJECTORY, {"joint_names": names, "points": points}) == expected


@pytest.mark.parametrize("number", [nan, inf, -inf, 1e3])
def test_invalid_numbers_are_refused(number):
    with pytest.raises(ValueError, match="expected"):
        read(TWIST, {"linear": {"x": number}})
    with pytest.raises(ValueError, match="expected"):
        read(STATE, {"name": ["head_pan"], "position": [number]})


@pytest.mark.parametrize(
    ("source", "contents"),
    [(STATE, {"name": ["head_pan"]}), (TRAJECTORY, {"joint_names": ["head_pan"]})],
)
def test_joints_without_angles_are_refused(source, contents):
    with pytest.raises(ValueError, match="malformed"):
        read(source, contents)


@given(st.sampled_from(INPUTS), st.binary(max_size=300))
def test_other_bytes_give_a_command_within_limits_or_are_refused(source, payload):
    try:
        command = source.read(MESSAGES.store, payload, JOINTS)
    except ValueError:
        return
    values = command.values() if isinstance(command, dict) else command
    assert all(abs(value) <= MAX_NUMBER for value in values)
