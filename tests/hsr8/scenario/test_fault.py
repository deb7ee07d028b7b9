from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import ScenarioError
from hsr8.scenario.fault import CameraBlack, Fault, ServoStuck
from hsr8.scenario.loader import dump, load_scenario, loads
from walking.body.tree import JOINT_NAMES

MAGNITUDES = {
    "lighting": 0.5,
    "camera-drops": 0.2,
    "missed-detections": 0.2,
    "false-detections": 0.5,
    "camera-latency": 0.1,
    "attitude-bias": 0.02,
    "gyro-bias": 0.02,
    "encoder-offset": 0.02,
    "foot-gain": 0.5,
    "servo-weak": 0.5,
    "servo-delay": 0.01,
    "push": 0.5,
    "low-friction": 0.2,
    "bump": 0.01,
}
MORE = {"servo-stuck": 'joint="l_knee"', "bump": "position=[0.5,0.0]"}
KINDS = [kind.model_fields["kind"].annotation.__args__[0] for kind in get_args(get_args(Fault)[0])]


def fault_of(kind, **given):
    """TOML text of a fault of this kind with its required keys."""
    keys = {"kind": f'"{kind}"', "start": "1.0"}
    if kind in MAGNITUDES:
        keys["magnitude"] = str(MAGNITUDES[kind])
    keys |= given
    more = [MORE[kind]] if kind in MORE else []
    return "{" + ",".join([*(f"{k}={v}" for k, v in keys.items()), *more]) + "}"


def test_groups_of_joints():
    counts = {"all": len(JOINT_NAMES), "legs": 12, "left_leg": 6, "right_leg": 6}
    for joint, count in counts.items():
        assert len(ServoStuck(kind="servo-stuck", joint=joint).joints(JOINT_NAMES)) == count
    assert ServoStuck(kind="servo-stuck", joint="right_leg").joints(JOINT_NAMES) == [*range(6, 12)]


@given(start=st.floats(0.0, 100.0), duration=st.floats(0.005, 100.0))
def test_begin_and_end_are_the_ticks_at_which_the_fault_acts(start, duration):
    fault = CameraBlack(kind="camera-black", start=start, duration=duration)
    first, over = round(fault.begin / 0.005), round(fault.end / 0.005)
    assert abs(fault.begin - start) < 0.00251
    assert (fault.begin, fault.end) == (round(0.005 * first, 3), round(0.005 * over, 3))
    assert not fault.acts(first - 1)
    assert all(fault.acts(tick) for tick in (first, over - 1))
    assert not fault.acts(over)


def test_all_kinds_can_be_given_together():
    assert len(set(KINDS)) == len(KINDS) == 20
    scenario = load_scenario("quick", [f"fault=[{','.join(map(fault_of, KINDS))}]"])
    assert [f.kind for f in scenario.fault] == KINDS
    assert loads(dump(scenario)) == scenario


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ([f"fault=[{fault_of('low-fricton')}]"], "did you mean 'low-friction'"),
        ([f"fault=[{fault_of('attitude-bias', magnitude='0.9')}]"], "fault[0].magnitude"),
        (
            [f"fault=[{fault_of('camera-black', start='99.0')}]"],
            "must be before the end of the run",
        ),
        ([f"fault=[{fault_of('low-friction', position='[9.0,0.0]')}]"], "outside the field"),
        ([f"fault=[{','.join([fault_of('mover-appears')] * 2)}]"], "mover 0 appears twice"),
        (['robot.body="kinematic"', f"fault=[{fault_of('bump')}]"], "requires robot.body"),
        (["camera.latency_ms=450", f"fault=[{fault_of('camera-latency')}]"], "at most 500"),
    ],
)
def test_an_inconsistent_fault_is_one_mistake(settings, expected):
    with pytest.raises(ScenarioError) as error:
        load_scenario("quick", settings)
    assert "1 mistake in" in str(error.value)
    assert expected in str(error.value)
