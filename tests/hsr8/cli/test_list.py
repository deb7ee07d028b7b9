import json

from hsr8.cli.list import main
from hsr8.cli.options import List
from hsr8.scenario.layers import built_in_names


def test_every_built_in_scenario_is_listed(capsys):
    assert main(List(json=True)) == 0
    entries = json.loads(capsys.readouterr().out)["scenarios"]
    assert [e["name"] for e in entries] == built_in_names()
    by_name = {e["name"]: e for e in entries}
    paper = by_name["paper"]
    assert (paper["static"], paper["moving"], paper["duration_s"]) == (12, 4, 560.2)
    assert by_name["conflict"]["moving"] == 6
    assert by_name["corridor"]["static"] > 10
