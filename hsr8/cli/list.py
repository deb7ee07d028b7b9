"""``hsr8 list``: the built-in scenarios."""

from rich.console import Console

from hsr8.cli import tables
from hsr8.cli.options import List
from hsr8.files import atomic
from hsr8.scenario.layers import built_in_names
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.scenario.track import n_placed


def main(options: List) -> int:
    """Print every built-in scenario with its description."""
    entries = [_entry(load_scenario(name)) for name in built_in_names()]
    if options.json:
        print(atomic.dumps({"scenarios": entries}))
        return 0
    console = Console(highlight=False)
    console.print(tables.rows(entries, "scenarios"))
    console.print("show one    hsr8 check NAME\nrun it      hsr8 run NAME")
    return 0


def _entry(scenario: Scenario) -> dict[str, object]:
    world = scenario.world
    walls = sum(len(wall.positions(scenario.robot.radius)) for wall in world.wall)
    return {
        "name": scenario.name,
        "static": world.n_static + len(world.obstacle) + walls,
        "moving": world.n_moving + world.encounters.n + n_placed(scenario),
        "mission": scenario.mission.kind,
        "duration_s": scenario.duration,
        "description": scenario.description,
    }
