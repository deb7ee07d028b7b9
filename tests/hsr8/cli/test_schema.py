import json
import tomllib

from hsr8.cli.main import entry
from hsr8.scenario.layers import BUILT_IN


def test_the_schema_has_every_key_of_the_built_in_scenarios(capsys):
    assert entry(["schema"]) == 0
    schema = json.loads(capsys.readouterr().out)
    assert schema["$schema"].startswith("https://json-schema.org/")
    for file in BUILT_IN.glob("*.toml"):
        assert set(tomllib.loads(file.read_text())) <= set(schema["properties"])


def test_the_file_has_the_same_schema(tmp_path, capsys):
    entry(["schema"])
    printed = json.loads(capsys.readouterr().out)
    assert entry(["schema", "--out", str(tmp_path / "s.json")]) == 0
    assert json.loads((tmp_path / "s.json").read_text()) == printed
