import json
import tomllib
from dataclasses import asdict, replace

from hsr8.scenario.loader import load_scenario
from hsr8.sweep.definition import (
    Definition,
    scenario_differences,
    version_differences,
)


def test_it_is_read_back(definition):
    assert Definition.from_json(json.loads(json.dumps(asdict(definition)))) == definition


def test_a_run_is_repeated_by_words_that_a_shell_understands(definition):
    assert definition.command(3) == "hsr8 run course --set 'a=[1, 2]' --seed 3"


def test_differences_are_of_values_and_symmetric(definition):
    other = replace(definition, scenario="duration = 4.0\n[[world.mover]]\nspeed = 1\n")
    there, back = scenario_differences(definition, other), scenario_differences(other, definition)
    assert there["duration"] == ("3.0", "4.0")
    assert there["world.mover.0.speed"] == ("-", "1")
    assert "seed" not in there
    assert {key: (b, a) for key, (a, b) in there.items()} == back
    assert scenario_differences(definition, definition) == {}


def test_versions_differ(definition):
    other = replace(definition, hsr8="2", libraries={"mujoco": "5"})
    assert version_differences(definition, other) == {"hsr8": ("1", "2"), "mujoco": ("4", "5")}


def test_now_names_what_is_installed():
    now = Definition.now(load_scenario("quick"), ())
    assert now.libraries["mujoco"] in now.made_with()
    assert tomllib.loads(now.scenario)["name"] == now.name == "quick"
