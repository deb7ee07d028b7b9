"""Settings and constants of a scenario: single keys over those of its file."""

from math import atan, degrees, tan

import numpy as np
import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario.constants import constant_names
from hsr8.scenario.loader import dump, load_scenario, loads


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
    with pytest.raises(
        ScenarioError, match=r"setting world\.n_moving: expected a TOML value, got NoneType"
    ):
        load_scenario("course", {"world.n_moving": None})


@pytest.mark.parametrize(
    ("override", "expected"),
    [
        ("camera.perod_ms=80", "did you mean 'period_ms'"),
        ("camera.period_ms", "expected key=value"),
        ("=3", "expected key=value"),
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


def test_mistakes_in_varied_values_name_the_option():
    with pytest.raises(ScenarioError, match=r"--vary wold.x=1: wold: unknown key"):
        load_scenario("quick", more={"--vary": ["wold.x=1"]})
    with pytest.raises(ScenarioError, match="--vary x: expected key=value"):
        load_scenario("quick", more={"--vary": ["x"]})


LOOK_TIME = "navigation.gaze.risk.look_time"


@pytest.mark.parametrize("profile", ["extended", "paper"])
def test_a_constant_is_changed_and_written_where_it_differs_from_the_profile(profile):
    usual = load_scenario("course", [f"navigation.profile={profile}"])
    assert "[constants" not in dump(usual)
    changes = {f"constants.{LOOK_TIME}": 2.25, "constants.navigation.gaze.undetected.reach": 0.5}
    changed = load_scenario("course", {"navigation.profile": profile, **changes})
    assert changed.navigation.gaze.risk.look_time == 2.25
    assert changed.navigation.gaze.undetected.reach == 0.5
    assert changed.navigation.univector == usual.navigation.univector
    text = dump(changed)
    assert "[constants.navigation.gaze.undetected]\nreach = 0.5" in text.replace(
        "look_time = 2.25\n", ""
    )
    assert loads(text) == changed


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (
            "[navigation.gaze.risk]\nlook_time = 2.0",
            f"3: {LOOK_TIME}: a constant, not a setting; for studies, constants.{LOOK_TIME}",
        ),
        (
            '[constants]\nnavigation.gaze.mode = "steps"',
            "3: constants.navigation.gaze.mode: a setting, not a constant; "
            "expected navigation.gaze.mode",
        ),
        (
            "[constants]\nnavigation.gaze.risk.look_tim = 2.0",
            f"3: constants.navigation.gaze.risk.look_tim: unknown constant; did you mean "
            f"'{LOOK_TIME}'?",
        ),
        (
            f'[constants]\n{LOOK_TIME} = "two"',
            f'3: constants.{LOOK_TIME}: wrong value, got "two"; expected a number',
        ),
        ("[constants]\ncamera.width = 3", "3: constants.camera.width: unknown constant"),
        ("constants = 3", "2: constants: must be a table"),
    ],
)
def test_a_wrong_constant_is_refused_with_its_line(text, wanted):
    with pytest.raises(ScenarioError) as error:
        loads('mission = {kind = "course"}\n' + text, "file.toml")
    assert str(error.value).splitlines()[1:] == [f"  file.toml:{wanted}"]


def test_every_constant_can_be_given_and_comes_back():
    scenario = load_scenario("course")
    for name in constant_names():
        value = scenario
        for part in name.split("."):
            value = getattr(value, part)
        assert load_scenario("course", {f"constants.{name}": value}) == scenario
