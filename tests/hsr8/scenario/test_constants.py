"""The table [constants]."""

import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario.constants import constant_names
from hsr8.scenario.loader import dump, load_scenario, loads

COURSE = 'mission = {kind = "course"}\n'
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
            '[constants]\nnavigation.gaze.mode = "sweep"',
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
        loads(COURSE + text, "file.toml")
    assert str(error.value).splitlines()[1:] == [f"  file.toml:{wanted}"]


def test_every_constant_can_be_given_and_comes_back():
    scenario = load_scenario("course")
    for name in constant_names():
        value = scenario
        for part in name.split("."):
            value = getattr(value, part)
        assert load_scenario("course", {f"constants.{name}": value}) == scenario
