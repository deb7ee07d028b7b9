import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario import renamed
from hsr8.scenario.constants import constant_names
from hsr8.scenario.loader import load_scenario, loads
from hsr8.scenario.public_keys import LIBRARIES, PUBLIC
from hsr8.scenario.reference import json_schema, resolve

TEXT = """\
mission = {kind = "course"}
[world]
old_size = 3
[navigation.gate]
enabled = true
[[world.row]]
start = [0.0, 0.0]
[constants.navigation.gate]
width = 3.0
[[fault]]
kind = "late"
size = 1.0
"""


@pytest.fixture
def names(monkeypatch):
    keys = {
        "fault.size": "fault.magnitude",
        "navigation.gate": "navigation.unseen_ground",
        "world.old_size": "world.size",
        "world.row": "world.wall",
    }
    monkeypatch.setattr(renamed, "RENAMED", keys)
    monkeypatch.setattr(renamed, "RENAMED_VALUES", {"fault.kind": {"late": "latency"}})


def test_an_old_key_is_refused_with_its_line_and_its_new_name(names):
    with pytest.raises(ScenarioError) as error:
        loads(TEXT, "file.toml")
    assert [line.strip() for line in str(error.value).splitlines()[1:]] == [
        "file.toml:3: world.old_size: renamed to world.size",
        "file.toml:6: world.row: renamed to world.wall",
        "file.toml:5: navigation.gate.enabled: renamed to navigation.unseen_ground.enabled",
        "file.toml:9: constants.navigation.gate.width: renamed to navigation.unseen_ground; "
        "expected one of its keys, or a constant of constants.navigation.unseen_ground",
        'file.toml:11: fault[0].kind: "late" is renamed to "latency"',
        "file.toml:12: fault[0].size: renamed to fault.magnitude",
    ]


def test_an_old_key_of_a_setting_is_refused(names):
    with pytest.raises(ScenarioError, match=r"--set navigation.gate.enabled=true: .*renamed to"):
        load_scenario("quick", ["navigation.gate.enabled=true"])


def test_new_keys_exist_and_old_keys_do_not():
    known = {*PUBLIC, *constant_names()} | {
        ".".join(key) for key in keys_of(json_schema()) if key[0] not in LIBRARIES
    }
    known |= {key[:k] for key in known for k, c in enumerate(key) if c == "."}
    assert set(renamed.RENAMED.values()) <= known
    assert not set(renamed.RENAMED) & known
    assert list(renamed.RENAMED) == sorted(renamed.RENAMED)
    assert set(renamed.RENAMED_VALUES) <= known


def keys_of(node, path=()):
    """Paths of all keys in a schema, those of all variants included."""
    node = resolve(node, None)
    node = resolve(node.get("items", node), None)
    for variant in node.get("discriminator", {}).get("mapping", {}).values():
        yield from keys_of({"$ref": variant}, path)
    for key, inner in node.get("properties", {}).items():
        yield (*path, key)
        yield from keys_of(inner, (*path, key))
