"""Walk random command states in full physics under sensor noise.

    python scripts/command_study.py --seeds 1000 1001 1002 1003 --duration 120 --write

Every number of the command state is drawn anew, from wider than the limits let through, every
0.2 to 0.6 s or in every control tick. Tune on seeds 0-99, report on seeds from 1000.
"""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

from walking.body.robot_model import RobotModel
from walking.command import CommandState, HeadTarget
from walking.command_limits import Limit
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD

import numpy as np
from study_page import options_of, write_page
from walking_body import ROBOT, Body, Plant
from walking_trial import SAMPLE, parameters_of

PAGE = "command-states.md"
GENERATORS = ("dcm", "robust")
EVERY = {"every 0.2-0.6 s": (0.2, 0.6), "every tick": (CONTROL_PERIOD, CONTROL_PERIOD)}
# single support, double support [s], forward, side [m], direction [rad], swing height [m]
LOW = (0.16, 0.03, -0.08, 0.06, -0.35, 0.01)
HIGH = (0.45, 0.15, 0.12, 0.14, 0.35, 0.042)


def random_states(seed: int, every: tuple[float, float]) -> Callable[[float], CommandState]:
    """Command states, each for a random time [s]; to be asked with times that only grow."""
    rng = np.random.default_rng([seed, 17])
    until, command = 0.0, CommandState()

    def script(now: float) -> CommandState:
        nonlocal until, command
        if now >= until - 1e-9:
            command = CommandState(*rng.uniform(LOW, HIGH).tolist())
            until += float(rng.uniform(*every))
        return command

    return script


@dataclass
class Tally:
    """What the walks of a row left behind."""

    ticks: int = 0
    altered: int = 0
    steps: int = 0
    outside: int = 0
    tilt: list[float] = field(default_factory=list)
    falls: list[float] = field(default_factory=list)
    by_limit: Counter[Limit] = field(default_factory=Counter)

    def walk(
        self,
        engine_of: Callable[[], WalkingEngine],
        body_of: Callable[[], Body],
        script: Callable[[float], CommandState],
        duration: float,
    ) -> None:
        """Walk a script; after a fall a fresh robot goes on."""
        body, engine, steps = body_of(), engine_of(), 0
        for tick in range(round(duration / CONTROL_PERIOD)):
            now = tick * CONTROL_PERIOD
            targets = engine.step(body.sense(), script(now), HeadTarget())
            body.apply(targets.setpoint)
            self.ticks += 1
            limits = engine.limits
            self.altered += bool(limits)
            self.by_limit.update(set(limits))
            self.outside += engine.zmp_depth < 0.0
            if tick % SAMPLE == 0:
                self.tilt.append(float(np.degrees(np.arccos(min(1.0, body.up)))))
                steps = engine.state().step_count
            if body.fallen:
                self.falls.append(now)
                self.steps += steps
                body, engine, steps = body_of(), engine_of(), 0
        self.steps += steps

    def row(self, name: str) -> str:
        """Row of the table."""
        share = 100.0 / self.ticks
        bound = ", ".join(f"{limit} {share * n:.1f}" for limit, n in self.by_limit.most_common())
        return (
            f"| {name} | {self.ticks * CONTROL_PERIOD:.0f} | {self.steps} | {len(self.falls)} | "
            f"{np.percentile(self.tilt, 99):.1f} | {self.outside} | {share * self.altered:.1f} | "
            f"{bound} |"
        )


HEAD = (
    "| generator, commands | walked [s] | steps | falls | tilt p99 [deg] | planned ZMP outside "
    "[ticks] | altered [% of ticks] | by constraint [% of ticks] |\n"
    "|---|---|---|---|---|---|---|---|"
)


def conditions() -> str:
    """What was walked."""
    ranges = "; ".join(f"{low:g} to {high:g}" for low, high in zip(LOW, HIGH, strict=True))
    return (
        "Leg collisions and sensor noise on. Single and double support [s], forward, side [m], "
        f"direction [rad] and swing height [m] are uniform in {ranges}, partly beyond the limits. "
        "After a fall a fresh robot goes on. Several constraints may bind in one tick; landing "
        "frozen, timing and swing height bind for the footstep under way alone."
    )


def main() -> None:
    """Command line."""
    options = options_of(__doc__, 30.0, PAGE)
    robot = RobotModel.from_mjcf(ROBOT)
    rows = []
    print(HEAD)
    for generator in GENERATORS:
        parameters = parameters_of([f"pattern.generator={generator}"])
        for name, every in EVERY.items():
            tally = Tally()
            for seed in options.seeds:
                rng = np.random.default_rng([seed, 3])
                tally.walk(
                    lambda p=parameters: WalkingEngine(robot, p),
                    lambda rng=rng: Body(rng, Plant()),
                    random_states(seed, every),
                    options.duration,
                )
            rows.append(tally.row(f"{generator}, {name}"))
            print(rows[-1], flush=True)
    if options.write:
        write_page(PAGE, "Command states in full physics", conditions(), [HEAD, *rows])


if __name__ == "__main__":
    main()
