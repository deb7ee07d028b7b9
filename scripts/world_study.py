"""How many drawn worlds are rejected, and what the certificates of the others are like.

    python scripts/world_study.py --seeds 0-99 --write

The nominal walk is that of ``world.encounters``: straight from point to point at a steady
pace, blind. A world that it crosses without a contact asks nothing of navigation.
"""

import argparse
from time import perf_counter

from hsr8.render.plan_view import PlanView
from hsr8.render.png import write_png
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.world.field.certificate import min_clearance, straight_length
from hsr8.world.field.encounter import NominalWalk
from hsr8.world.field.generator import draw_world
from hsr8.world.field.layout import Layout

import numpy as np
from study_page import RESULTS, add_seeds, command_line, environment

PICTURED = "course crowd dense fast conflict behind corridor crossing blind-corner pedestrians"
FAMILIES = f"{PICTURED} paper quick"
PAGE = RESULTS / "worlds.md"
PICTURES = PAGE.parents[1] / "images" / "worlds"
PICTURE = 640  # longer side [pixel]
STEP = 0.05  # of the nominal walk [s]
HEADER = (
    "family | static + moving | rejected | crowded | nominal walk hits | way [m] | over straight | "
    "time [s] | least clearance [m] | to draw and certify [s]"
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_seeds(parser, range(100))
    parser.add_argument("--families", nargs="+", default=FAMILIES.split())
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.name} and images")
    options = parser.parse_args()
    table = [f"| {HEADER} |", "|---" * (HEADER.count("|") + 1) + "|"]
    for name in options.families:
        table.append(row(name, options.seeds))
        print(table[-1], flush=True)
    if options.write:
        for name in PICTURED.split():
            scenario = load_scenario(name)
            world = draw_world(scenario, scenario.seed)
            picture = PlanView(
                world.layout, scenario.robot.radius, PICTURE, world.certificate
            ).draw()
            write_png(PICTURES / f"{name}.png", picture)
        PAGE.write_text(page(options.seeds, table))


def row(name: str, seeds: list[int]) -> str:
    """One family."""
    scenario = load_scenario(name)
    rejected, crowded, hits, cost, ways = 0, 0, 0, [], []
    for seed in seeds:
        begin = perf_counter()
        world = draw_world(scenario, seed)
        cost.append(perf_counter() - begin)
        rejected += world.rejected
        crowded += world.crowded
        hits += hits_blindly(scenario, world.layout)
        certificate, n = world.certificate, world.certificate.points
        straight = straight_length(world.layout, n)
        clearance = min_clearance(world.layout, certificate.path, scenario.robot.radius)
        ways.append(
            (certificate.length, certificate.length / straight, certificate.time, clearance)
        )
    length, over, time, clearance = np.array(ways).T
    cells = [
        f"`{name}`",
        f"{len(world.layout.static)} + {len(world.layout.movers)}",
        f"{rejected} of {len(seeds) + rejected}",
        f"{crowded}",
        f"{hits / len(seeds):.0%}",
        spread(length, ".1f"),
        f"{np.median(over):.2f}",
        spread(time, ".0f"),
        f"{clearance.min():.3f}",
        f"{np.mean(cost):.2f}, at most {np.max(cost):.2f}",
    ]
    return "| " + " | ".join(cells) + " |"


def hits_blindly(scenario: Scenario, layout: Layout) -> bool:
    """Whether a robot on the nominal walk touches anything; a tour is walked once round."""
    start = layout.start[:2]
    pace = scenario.world.encounters.pace * scenario.robot.speed.vx
    walk = NominalWalk([start, *map(tuple, layout.waypoints.tolist())], pace)
    times = np.arange(0.0, walk.duration, STEP).tolist()
    places = np.array([walk.at(time)[0] for time in times])
    for o in layout.obstacles:
        at = np.array([o.motion.position(t) for t in times]) if o.motion else o.position
        if np.hypot(*(places - at).T).min() < o.radius + scenario.robot.radius:
            return True
    return False


def spread(values: np.ndarray, form: str) -> str:
    """Median and the range of nine in ten."""
    low, middle, high = np.quantile(values, (0.05, 0.5, 0.95))
    return f"{middle:{form}} ({low:{form}} to {high:{form}})"


def page(seeds: list[int], table: list[str]) -> str:
    """The page of results."""
    lines = [
        "# Worlds: rejections and certificates",
        "",
        f"    {command_line()}",
        "",
        f"{environment(('hsr8', 'numpy'))}. Seeds {seeds[0]} to {seeds[-1]}.",
        "",
        "Rejected: random worlds without a path to the goal, of all. Crowded: attempts in which "
        "something found no place. Nominal walk hits: a blind robot that goes straight from point "
        "to point at the nominal pace touches something. Way, its ratio to the straight lines, "
        "time: of the certificates, median and the range of nine in ten worlds. Of `paper` the "
        "certificate covers the first 8 points of the tour; its nominal walk is the whole tour "
        "once. Least clearance: the smallest of all certificates, between the robot's circle and "
        "any surface; 0.02 m is asked for. Time to draw and certify: wall time on a machine that "
        "was busy with other work as well.",
        "",
        *table,
        "",
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
