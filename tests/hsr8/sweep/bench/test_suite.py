import re

import pytest

from hsr8.errors import ScenarioError, UsageError
from hsr8.sweep.bench.suite import SHIPPED, changed_settings, read_suite, scenario_hash
from hsr8.sweep.seeds import parse_seeds

HASHES = {1: "0e8b180c21c0", 2: "664c80072592"}
"""Digest of each version of the shipped suite. Results of a version remain comparable only as long
as its worlds, robot and camera do: give a changed suite a new version in `suite.toml`.
A new key whose default changes no world changes the digest only."""
SMALL = """
name = "small"
version = 3
quick = "1000"
full = "1000:1003"
settings = ["robot.body=kinematic", "camera.source=analytic"]

[families]
"yard.toml" = "a file"
quick = "a name"
"""


@pytest.fixture
def small(tmp_path):
    (tmp_path / "yard.toml").write_text('extends = "course"\nworld.n_static = 7\n')
    file = tmp_path / "small.toml"
    file.write_text(SMALL)
    return file


def shipped():
    suite = read_suite(SHIPPED)
    return suite, suite.scenarios(SHIPPED)


def test_the_shipped_suite_is_that_of_its_version():
    suite, standard = shipped()
    assert suite.digest(standard) == HASHES[suite.version]


def test_the_shipped_suite_has_six_families_and_seeds_for_reporting():
    suite, standard = shipped()
    quick, full = set(parse_seeds(suite.quick)), set(parse_seeds(suite.full))
    assert quick < full <= set(range(1000, 2000))
    assert len(standard) == 6
    assert {s.robot.body for s in standard.values()} == {"kinematic"}
    assert {(s.camera.source, s.camera.preset) for s in standard.values()} == {
        ("analytic", "realistic")
    }
    assert {s.robot.model for s in standard.values()} == {"hsr8"}


def test_settings_of_the_algorithms_do_not_change_the_suite(small):
    suite = read_suite(small)
    standard = suite.scenarios(small)
    other = suite.scenarios(small, ["navigation.planner.method=orca"])
    assert suite.digest(other) == suite.digest(standard)
    assert set(changed_settings(standard, other)) == {"navigation.planner.method"}
    assert scenario_hash(other["yard"]) != scenario_hash(standard["yard"])


@pytest.mark.parametrize("setting", ["robot.body=full", "camera.preset=ideal"])
def test_body_and_camera_may_change_and_are_reported(small, setting):
    suite = read_suite(small)
    standard, other = suite.scenarios(small), suite.scenarios(small, [setting])
    assert suite.digest(other) != suite.digest(standard)
    assert setting.partition("=")[0] in changed_settings(standard, other)


@pytest.mark.parametrize(
    "setting",
    [
        *("world.n_static=3", "duration=5", "robot.speed.vx=0.1"),
    ],
)
def test_worlds_and_missions_may_not_change(small, setting):
    suite = read_suite(small)
    key, _, value = setting.partition("=")
    with pytest.raises(UsageError, match=f"  yard: {key}: {value}.*; expected"):
        changed_settings(suite.scenarios(small), suite.scenarios(small, [setting]))


def test_only_families_that_differ_are_named(small):
    suite = read_suite(small)
    with pytest.raises(UsageError) as error:
        changed_settings(suite.scenarios(small), suite.scenarios(small, ["world.n_static=7"]))
    assert "quick: world.n_static: 7; expected" in str(error.value)
    assert "yard" not in str(error.value)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("version = 3", "version = 4"),
        ('full = "1000:1003"', 'full = "1000:1004"'),
        ('"robot.body=kinematic"', '"robot.body=full"'),
        ('quick = "a name"', 'dense = "a name"'),
    ],
)
def test_the_digest_is_of_all_that_makes_results_comparable(small, old, new):
    suite = read_suite(small)
    digest = suite.digest(suite.scenarios(small))
    small.write_text(SMALL.replace(old, new))
    changed = read_suite(small)
    assert changed.digest(changed.scenarios(small)) != digest


def test_files_of_scenarios_are_next_to_the_suite(small, monkeypatch):
    monkeypatch.chdir("/")
    scenarios = read_suite(small).scenarios(small)
    assert list(scenarios) == ["yard", "quick"]
    assert scenarios["yard"].world.n_static == 7


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "version = 3",
            "version = 0",
            "small.toml:[0-9]+: version: wrong value, got 0; expected at least 1",
        ),
        (
            "version = 3",
            "version = 3\nsize = 3",
            "size: unknown key; expected one of name, version",
        ),
        ('name = "small"', "name = ", "invalid TOML"),
    ],
)
def test_mistakes_in_a_suite_are_named(small, old, new, message):
    small.write_text(SMALL.replace(old, new, 1))
    with pytest.raises(UsageError, match=f"--suite {re.escape(str(small))}: (.*\n)*.*{message}"):
        read_suite(small)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('quick = "a name"', 'quik = ""', "families.quik: unknown scenario 'quik'; did you mean"),
        ("source=", "sorce=", r"families.yard.toml: .*\n *small.toml: settings camera.sorce=.*"),
    ],
)
def test_mistakes_in_families_and_settings_name_the_suite(small, old, new, message):
    small.write_text(SMALL.replace(old, new))
    with pytest.raises(ScenarioError, match=f"^{re.escape(str(small))}: {message}") as error:
        read_suite(small).scenarios(small)
    assert "--set" not in str(error.value)
