"""How far beyond the border of an image its camera still recognises obstacles that are near.

    python scripts/border_study.py behind --seeds 0-3 --cameras rendered analytic

Obstacles to the side of the robot or behind it, by where their middle would be in the image: at 0
in the centre, at 1 on its left or right border, at 1.2 beyond it by a tenth of the width. What is
seen there is a strip of a cylinder. Both cameras ride on the same robot in the same worlds.
"""

import argparse
from collections import Counter
from dataclasses import dataclass, field
from itertools import pairwise
from math import atan2, hypot, radians, tan

from hsr8.loop import Simulation
from hsr8.recorder.record import Listener, TickRecord
from hsr8.scenario.loader import load_scenario

import numpy as np
from study_page import add_seeds

ASIDE = radians(95.0)  # bearing from which an obstacle is looked at over the shoulder
DISTANCES = (0.4, 0.8, 1.5)  # ends of the classes of distance [m]
EDGES = (0.8, 1.0, 1.1, 1.2, 1.3, 1.4)  # of the classes of offset
MATCH = 0.2  # a detection so near to an obstacle is of it [m]


@dataclass
class Tally(Listener):
    """Listener that counts what was there and what of it was detected, by distance and offset."""

    simulation: Simulation
    there: Counter[tuple[float, float]] = field(default_factory=Counter)
    seen: Counter[tuple[float, float]] = field(default_factory=Counter)

    def on_record(self, record: TickRecord) -> None:
        """Judge its frame, if it has one."""
        if record.frame is None:
            return
        measured, truth = record.frame.measured, record.truth
        if abs(measured.time - record.time) > 1e-9:
            raise SystemExit("this study needs camera.latency_ms = 0 and frames at records")
        view, (x0, y0, heading) = measured.view, truth.robot.tolist()
        c, s = np.cos(heading), np.sin(heading)
        centres = (truth.obstacle_positions - (x0, y0)) @ np.array([[c, -s], [s, c]])
        found = [
            (o.distance * np.cos(o.bearing), o.distance * np.sin(o.bearing))
            for o in measured.observations
        ]
        for (x, y), thing in zip(centres.tolist(), self.simulation.layout.obstacles, strict=True):
            middle = view.rotation.T @ (np.array([x, y, 0.5 * thing.height]) - view.position)
            if abs(atan2(y, x)) < ASIDE or middle[2] <= 0.0:
                continue
            across = abs(middle[0] / middle[2]) / tan(0.5 * view.horizontal_fov)
            down = abs(middle[1] / middle[2]) / tan(0.5 * view.vertical_fov)
            near = [d for d in DISTANCES if hypot(x, y) < d]
            edges = [e for e in EDGES if across >= e]
            if near and edges and down < 1.0 and across < EDGES[-1]:
                key = near[0], edges[-1]
                self.there[key] += 1
                self.seen[key] += any(hypot(u - x, v - y) < MATCH for u, v in found)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario")
    add_seeds(parser, range(4))
    parser.add_argument("--cameras", nargs="+", default=["rendered", "analytic"])
    parser.add_argument("--set", nargs="*", default=[], help="settings, key=value")
    arguments = parser.parse_args()
    there: dict[str, Counter[tuple[float, float]]] = {}
    seen: dict[str, Counter[tuple[float, float]]] = {}
    for camera in arguments.cameras:
        there[camera], seen[camera] = Counter(), Counter()
        for seed in arguments.seeds:
            settings = [f"camera.source={camera}", *arguments.set]
            simulation = Simulation(load_scenario(arguments.scenario, settings, seed), seed)
            tally = Tally(simulation)
            simulation.listeners.append(tally)
            simulation.run()
            there[camera] += tally.there
            seen[camera] += tally.seen
    print("| nearer than [m] | offset | " + " | ".join(arguments.cameras) + " |")
    print("|---|---|" + "---|" * len(arguments.cameras))
    for distance in DISTANCES:
        for low, high in pairwise(EDGES):
            cells = []
            for camera in arguments.cameras:
                n = there[camera][distance, low]
                cells.append(f"{seen[camera][distance, low] / n:.0%} of {n}" if n else "")
            print(f"| {distance} | {low} to {high} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
