"""Carried to the rim: how soon does a robot that faces outward know where it is?

In the 2-D loop of the decision study the robot is put down near a corner of the field,
looking out of it within 45 degrees, five seconds after the start. From there the head alone
reaches one beacon at most. Every turn rate is given the same worlds and places.

    python scripts/lost_study.py paper --seeds 0-19 --turns 0 0.5
"""

import argparse
from math import atan2, hypot, inf, pi

from hsr8.scenario.loader import load_scenario
from navigation.angles import wrap

import numpy as np
from decision_study import Run
from decision_world import TICK
from study_page import add_seeds

CARRIED, LIMIT = 5.0, 40.0  # times [s]
PLACE = 2.25  # of the corners the robot is put in [m]
FOUND, FOUND_TURN = 0.10, 0.09  # errors of a robot that knows where it is [m, rad]


def search(scenario: str, settings: list[str], seed: int) -> float:
    """Time until the pose is known again after it was lost [s], infinite for never."""
    run = Run(load_scenario(scenario, settings, seed), seed, "camera")
    rng = np.random.default_rng([seed, 2])
    corner = PLACE * rng.choice([-1.0, 1.0], 2)
    heading = atan2(corner[1], corner[0]) + rng.uniform(-pi / 4, pi / 4)
    noticed = False
    for tick in range(round((CARRIED + LIMIT) / TICK)):
        time = tick * TICK
        if tick == round(CARRIED / TICK):
            run.walker.pose[:] = [*corner, heading]
        run.turn_head()
        if tick % run.frame_ticks == 0:
            belief = run.sense(time)
            task = run.mission.update(belief.pose)
            run.look(belief, task)
            error = belief.pose - run.walker.pose
            near = hypot(error[0], error[1]) < FOUND and abs(wrap(float(error[2]))) < FOUND_TURN
            noticed |= belief.lost
            if time > CARRIED and noticed and not belief.lost and near:
                return time - CARRIED
        if tick % run.step_ticks == 0:
            run.motion = run.planner.plan(belief, task)
            run.walker.latch(run.motion.velocity)
        run.walker.step()
    return inf


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario")
    add_seeds(parser, range(10))
    parser.add_argument("--turns", type=float, nargs="+", default=[0.0, 0.5], help="[rad/s]")
    parser.add_argument("--set", nargs="*", default=[], help="settings of all runs, key=value")
    arguments = parser.parse_args()
    print("| turn rate while lost [rad/s] | N | found within 10 s, 40 s | median [s] | p90 [s] |")
    print("|---|---|---|---|---|")
    for turn in arguments.turns:
        settings = [*arguments.set, f"constants.navigation.velocity_mapping.lost_turn_rate={turn}"]
        times = [search(arguments.scenario, settings, seed) for seed in arguments.seeds]
        middle, late = np.percentile(times, [50, 90], method="higher")
        in_time = sum(t <= 10.0 for t in times), sum(t <= LIMIT for t in times)
        print(
            f"| {turn:g} | {len(times)} | {in_time[0]}, {in_time[1]} | {middle:.1f} | {late:.1f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
