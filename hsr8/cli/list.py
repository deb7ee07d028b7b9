"""``hsr8 list``: the scenarios that come with the program."""

import json

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from hsr8.cli.options import List
from hsr8.scenario.loader import built_in_names, load_scenario
from hsr8.scenario.schema import Scenario


def main(options: List) -> int:
    """Print every built-in scenario with what it is about."""
    scenarios = [load_scenario(name) for name in built_in_names()]
    if options.json:
        print(json.dumps({"scenarios": [_entry(s) for s in scenarios]}))
        return 0
    table = Table(title="Scenarios", title_justify="left")
    for heading in ("name", "obstacles", "mission"):
        table.add_column(heading)
    table.add_column(escape("time [s]"), justify="right")
    table.add_column("what it is")
    for scenario in scenarios:
        entry = _entry(scenario)
        table.add_row(
            scenario.name,
            f"{entry['static']} + {entry['moving']} moving",
            scenario.mission.kind,
            f"{scenario.duration:g}",
            scenario.description,
        )
    console = Console()
    console.print(table)
    console.print("Look at one: hsr8 check NAME. Run it: hsr8 run NAME.", highlight=False)
    return 0


def _entry(scenario: Scenario) -> dict[str, object]:
    world = scenario.world
    walls = sum(len(wall.positions()) for wall in world.wall)
    return {
        "name": scenario.name,
        "description": scenario.description,
        "mission": scenario.mission.kind,
        "static": world.n_static + len(world.obstacle) + walls,
        "moving": world.n_moving + world.encounters.n + len(world.mover),
        "duration": scenario.duration,
    }
