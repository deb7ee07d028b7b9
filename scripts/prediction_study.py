"""How well a mover's track says where it will be, by its kind of motion and its age.

    python scripts/prediction_study.py crowd --seeds 60-61

Runs with a kinematic body and the analytic camera, frame by frame. A track counts if it is called
moving, was seen last less than 0.1 m from a mover, and that one is now within 1.5 m of the robot.
A prediction walks the track's bend on (the middle one of a lost track's particles); to compare,
one that knows place and velocity and goes straight.
"""

import argparse
from collections import defaultdict
from collections.abc import Iterator
from typing import NamedTuple

from hsr8.loop import Simulation
from hsr8.scenario.loader import load_scenario
from navigation.belief.belief import Belief, Motion, Track
from navigation.motion.bend_kernel import mean_velocity

import numpy as np
from numpy.typing import NDArray
from study_page import STAND_INS, add_seeds, environment

Array = NDArray[np.float64]

SAME, NEAR = 0.1, 1.5  # distances of a track from its mover, and of that from the robot [m]
AHEAD = 2.0  # [s]
AGES = ((0.05, "in view"), (1.0, "to 1 s"), (2.0, "1 to 2 s"), (4.0, "2 to 4 s"))


class Score(NamedTuple):
    """Errors of one track in one frame [m/s, m, m, m]: the last knows and goes straight."""

    velocity: float
    place: float
    predicted: float
    straight: float


def scores(scenario: str, settings: list[str], seed: int) -> Iterator[tuple[str, str, Score]]:
    """Kind of motion, age and errors of every track in every frame of a run."""
    with Simulation(load_scenario(scenario, [*STAND_INS, *settings], seed), seed) as simulation:
        layout = simulation.layout
        kinds = [type(o.motion).__name__.lower() for o in layout.obstacles if o.motion]
        movers = layout.motion()
        while simulation.exit_reason is None:
            record = simulation.step()
            if record is None or record.frame is None:
                continue
            belief = record.frame.estimate
            places = movers.positions(belief.time)
            later = movers.positions(belief.time + AHEAD)
            velocities = movers.velocities(belief.time)
            for track in belief.tracks:
                i = _mover(track, movers.positions(belief.time - track.age))
                age = next((name for limit, name in AGES if track.age < limit), None)
                if i is None or age is None or _far(places[i], belief):
                    continue
                straight = places[i] + AHEAD * velocities[i]
                yield (
                    kinds[i],
                    age,
                    Score(
                        _norm(track.velocity - velocities[i]),
                        _norm(track.position - places[i]),
                        float(np.median(np.hypot(*(_ahead(track) - later[i]).T))),
                        _norm(straight - later[i]),
                    ),
                )


def _mover(track: Track, places: Array) -> int | None:
    """Which mover a track is of, by where it was seen last."""
    if track.motion is not Motion.MOVING:
        return None
    distances = np.hypot(*(places - track.last_seen).T)
    nearest = int(np.argmin(distances))
    return nearest if distances[nearest] < SAME else None


def _far(place: Array, belief: Belief) -> bool:
    return _norm(place - belief.pose[:2]) > NEAR


def _ahead(track: Track) -> Array:
    """Where the track's hypotheses will be (n, 2) [m]."""
    cloud = track.particles
    if cloud is None:
        rate = np.array([track.turn_rate])
        return track.position + AHEAD * mean_velocity(track.velocity[None], rate, AHEAD)
    return cloud.positions + AHEAD * mean_velocity(cloud.velocities, cloud.turn_rates, AHEAD)


def _norm(offset: Array) -> float:
    return float(np.hypot(offset[0], offset[1]))


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scenario")
    add_seeds(parser)
    parser.add_argument("--set", nargs="*", default=[], metavar="KEY=VALUE", dest="settings")
    args = parser.parse_args()
    found = defaultdict(list)
    for seed in args.seeds:
        for kind, age, score in scores(args.scenario, args.settings, seed):
            found[kind, age].append(score)
    print(environment())
    print(
        "\n| motion | last seen | frames | velocity rms [m/s] | place rms [m] "
        f"| {AHEAD:g} s ahead, median, 90 % [m] | knowing, straight, 90 % [m] |\n"
        "|---|---|---|---|---|---|---|"
    )
    for kind in sorted({kind for kind, _ in found}):
        for _, age in AGES:
            errors = np.array(found[kind, age]).reshape(-1, len(Score._fields))
            if len(errors) == 0:
                continue
            velocity, place = np.sqrt(np.mean(errors[:, :2] ** 2, axis=0))
            middle, most = np.quantile(errors[:, 2], (0.5, 0.9))
            straight = np.quantile(errors[:, 3], 0.9)
            print(
                f"| {kind} | {age} | {len(errors)} | {velocity:.3f} | {place:.3f} "
                f"| {middle:.3f}, {most:.3f} | {straight:.3f} |"
            )


if __name__ == "__main__":
    main()
