"""``hsr8 list``: the built-in scenarios."""

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from hsr8.cli.options import List
from hsr8.recorder.files import atomic
from hsr8.scenario.loader import built_in_names, load_scenario
from hsr8.scenario.schema import Scenario


def main(options: List) -> int:
    """Print every built-in scenario with its description."""
    entries = [_entry(load_scenario(name)) for name in built_in_names()]
    if options.json:
        print(atomic.dumps({"scenarios": entries}))
        return 0
    table = Table(title="Scenarios", title_justify="left")
    for heading in ("name", "obstacles", "mission"):
        table.add_column(heading)
    table.add_column(escape("time [s]"), justify="right")
    table.add_column("description")
    for entry in entries:
        table.add_row(
            str(entry["name"]),
            f"{entry['static']} + {entry['moving']} moving",
            str(entry["mission"]),
            f"{entry['duration']:g}",
            str(entry["description"]),
        )
    console = Console(highlight=False)
    console.print(table)
    console.print("show one    hsr8 check NAME\nrun it      hsr8 run NAME")
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
