"""Settings of a scenario: single keys over those of its file."""

from math import atan, degrees, tan

import numpy as np
import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import dump, load_scenario, loads
from hsr8.scenario.reference import parameters


def test_overrides_change_single_keys():
    scenario = load_scenario(
        "walk",
        [
            "camera.source=rendered",
            "camera.source=analytic",  # the last one counts
            "world.brightness=0.5",
            "command.stretch.1.vx=0.05",
            'robot.body="kinematic"',
        ],
        seed=77,
    )
    before = load_scenario("walk")
    assert scenario.camera.source == "analytic"
    assert scenario.robot.body == "kinematic"
    assert scenario.world.brightness == 0.5
    assert scenario.seed == 77
    assert scenario.command.stretch[1].vx == 0.05
    assert scenario.command.stretch[1].duration == before.command.stretch[1].duration
    assert scenario.command.stretch[0] == before.command.stretch[0]


def test_another_kind_of_fault_or_mover_drops_the_old_keys(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(
        'extends = "course"\n'
        '[[fault]]\nkind = "attitude-bias"\nmagnitude = 0.1\nstart = 3.0\n'
        '[[world.mover]]\nmotion = "circle"\ncentre = [1.0, 1.0]\npath_radius = 0.4\n'
    )
    changed = load_scenario(str(file), ["fault.0.kind=imu-frozen", "fault.0.start=4.0"])
    assert (changed.fault[0].kind, changed.fault[0].start) == ("imu-frozen", 4.0)
    line = ["motion=line", "start=[1.0, 1.0]", "heading_deg=90"]
    changed = load_scenario(str(file), [f"world.mover.0.{setting}" for setting in line])
    assert changed.world.mover[0].start == (1.0, 1.0)


def test_overrides_are_strings_or_a_mapping():
    wanted = load_scenario("course", ["world.n_moving=3", "world.size=[4.0, 6.0]"])
    assert load_scenario("course", {"world.n_moving": 3, "world.size": (4.0, 6.0)}) == wanted
    assert (
        load_scenario("course", {"world.n_moving": np.int64(3), "world.size": np.array([4, 6])})
        == wanted
    )
    assert load_scenario("course", "world.n_moving=3") == load_scenario(
        "course", ["world.n_moving=3"]
    )
    with pytest.raises(ScenarioError, match=r"settings: world\.n_moving: wrong type, got NoneType"):
        load_scenario("course", {"world.n_moving": None})


@pytest.mark.parametrize(
    ("override", "expected"),
    [
        ("camera.perod_ms=80", "did you mean 'period_ms'"),
        ("camera.period_ms", "expected key=value"),
        ("=3", "expected a dotted key"),
        ("extends=course", "extends is allowed in files only"),
        ("command.stretch.9.vx=1.0", "expected an index from 0 to 4, got '9'"),
        ("duration=1\nseed=3", "expected a number"),
    ],
)
def test_wrong_overrides_are_named(override, expected):
    with pytest.raises(ScenarioError) as caught:
        load_scenario("walk", [override])
    assert expected in str(caught.value)
    assert f"--set {override}" in str(caught.value)


def test_single_keys_take_precedence_over_profile_and_camera():
    scenario = load_scenario(
        "course",
        [
            *("navigation.profile=paper", "navigation.gaze.w_lm=0.5", "camera.preset=ideal"),
            "walking.head.max_rate=5.0",
        ],
    )
    assert scenario.navigation.gaze.mode == "integrated"
    assert scenario.navigation.gaze.w_lm == 0.5
    assert scenario.navigation.planner.method == "paper"
    assert scenario.camera.vertical_fov_deg == 70.0
    assert scenario.walking.head.max_rate == 5.0
    camera = load_scenario("course").camera
    half_width = tan(0.5 * camera.vertical_fov) * camera.width / camera.height
    assert degrees(2.0 * atan(half_width)) == pytest.approx(60.0, abs=0.1)
    assert loads(dump(scenario)) == scenario


LOOK_TIME = "navigation.gaze.risk.look_time"


@pytest.mark.parametrize("profile", ["extended", "paper"])
def test_every_parameter_can_be_given_and_comes_back(profile):
    scenario = load_scenario("course", [f"navigation.profile={profile}"])
    values = {}
    for name in parameters():
        value = scenario
        for part in name.split("."):
            value = getattr(value, part)
        values[name] = value
    assert load_scenario("course", values) == scenario
    changed = load_scenario("course", values | {LOOK_TIME: 2.25})
    assert changed.navigation.gaze.risk.look_time == 2.25
    assert loads(dump(changed)) == changed != scenario
