"""CPU time of the whole walking tick: generator, inverse kinematics, stabilizer, estimator.

    python scripts/tick_study.py --seeds 1000 1001 --duration 120 --write

Every row is walked in full physics under sensor noise with the garbage collector on, and again
with it frozen and off. Rare slow ticks are told apart by what happened in them: a collection
(and of which generation), or the process taken off its core, seen in wall time that is not CPU
time.
"""

import gc
import resource
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

from walking.body.robot_model import RobotModel
from walking.command import Command, HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD
from walking.warm_up import warm_up

import numpy as np
from command_study import EVERY, random_states
from study_page import options_of, write_page
from walking_body import ROBOT, Body, Plant
from walking_trial import BOX, parameters_of, random_script

PAGE = "walking-tick.md"
GENERATORS = ("dcm", "robust")
SLOW = 1.5  # CPU time of a tick that is looked into [ms]
VERY_SLOW = 5.0  # wall time of one [ms]

Script = Callable[[float], Command]


def velocities(seed: int) -> Script:
    """A new velocity every 0.5 to 2 s."""
    script = random_script(seed)
    return lambda now: script(now)[0]


def restless(seed: int) -> Script:
    """A new velocity in every tick."""
    rng = np.random.default_rng([seed, 23])
    low, high = np.array(BOX).T
    return lambda _now: VelocityCommand(*rng.uniform(low, high).tolist())


SCRIPTS: dict[str, Callable[[int], Script]] = {
    "velocity every 0.5-2 s": velocities,
    "velocity every tick": restless,
    "command state every tick": lambda seed: random_states(seed, EVERY["every tick"]),
}


@dataclass
class Times:
    """CPU and wall time of every tick of a row [ms], and what else happened in it."""

    cpu: list[float] = field(default_factory=list)
    wall: list[float] = field(default_factory=list)
    collected: list[int] = field(default_factory=list)  # oldest generation, -1 for none
    switched: list[int] = field(default_factory=list)  # times taken off the core
    falls: int = 0

    def row(self, name: str) -> str:
        """Row of the table."""
        cpu, wall = np.array(self.cpu), np.array(self.wall)
        p99, p999 = np.percentile(cpu, (99, 99.9))
        return (
            f"| {name} | {len(cpu)} | {cpu.mean():.3f} | {p99:.3f} | {p999:.3f} | "
            f"{cpu.max():.2f} | {np.percentile(wall, 99.9):.3f} | {wall.max():.2f} | "
            f"{self._causes()} | {self.falls} |"
        )

    def _causes(self) -> str:
        """What happened in slow ticks, and how often."""
        causes: Counter[str] = Counter()
        rows = zip(self.cpu, self.wall, self.collected, self.switched, strict=True)
        for cpu, wall, generation, switches in rows:
            if cpu <= SLOW and wall <= VERY_SLOW:
                continue
            if generation >= 0:
                causes[f"collection {generation}"] += 1
            elif switches:
                causes["off the core"] += 1
            else:
                causes["neither"] += 1
        return ", ".join(f"{cause} {n}" for cause, n in causes.most_common()) or "none"


class Collections:
    """Notes the oldest generation that the garbage collector went through."""

    def __init__(self) -> None:
        self.oldest = -1

    def __call__(self, phase: str, info: dict[str, int]) -> None:
        """Callback of `gc`."""
        if phase == "start":
            self.oldest = max(self.oldest, info["generation"])


def measure(
    times: Times,
    engine_of: Callable[[], WalkingEngine],
    body_of: Callable[[], Body],
    script: Script,
    duration: float,
) -> None:
    """Walk a script; after a fall a fresh robot goes on."""
    body, engine = body_of(), engine_of()
    collections = Collections()
    gc.callbacks.append(collections)
    for tick in range(round(duration / CONTROL_PERIOD)):
        command, sensors = script(tick * CONTROL_PERIOD), body.sense()
        collections.oldest = -1
        switches = resource.getrusage(resource.RUSAGE_SELF).ru_nivcsw
        wall, cpu = time.perf_counter(), time.process_time()
        targets = engine.step(sensors, command, HeadTarget())
        cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
        times.switched.append(resource.getrusage(resource.RUSAGE_SELF).ru_nivcsw - switches)
        times.cpu.append(1e3 * cpu)
        times.wall.append(1e3 * wall)
        times.collected.append(collections.oldest)
        body.apply(targets.setpoint)
        if body.fallen:
            times.falls += 1
            body, engine = body_of(), engine_of()
    gc.callbacks.remove(collections)


HEAD = (
    "| generator, commands, collector | ticks | mean | p99 | p99.9 | max | wall p99.9 | wall max | "
    f"ticks over {SLOW:g} ms CPU or {VERY_SLOW:g} ms wall, by cause | falls |\n"
    "|---|---|---|---|---|---|---|---|---|---|"
)


CONDITIONS = (
    "From sensors and command to the joints' setpoints, in ms, one core, in full physics under "
    "sensor noise; the first tick of every robot is among them, after the warm-up that is made "
    "with the robot. The collector is Python's garbage "
    "collector, on as it comes or frozen and off. Causes of slow ticks: a collection in the tick "
    "and its oldest generation, the process taken off its core, or neither."
)


def main() -> None:
    """Command line."""
    options = options_of(__doc__, 20.0, PAGE)
    robot = RobotModel.from_mjcf(ROBOT)
    rows = []
    print(HEAD)
    for generator in GENERATORS:
        parameters = parameters_of([f"pattern.generator={generator}"])
        warm_up(robot, parameters)
        for name, script_of in SCRIPTS.items():
            for collecting in (True, False):
                gc.collect()
                if not collecting:
                    gc.freeze()
                    gc.disable()
                times = Times()
                for seed in options.seeds:
                    rng = np.random.default_rng([seed, 3])
                    measure(
                        times,
                        lambda p=parameters: WalkingEngine(robot, p),
                        lambda rng=rng: Body(rng, Plant()),
                        script_of(seed),
                        options.duration,
                    )
                gc.unfreeze()
                gc.enable()
                rows.append(times.row(f"{generator}, {name}, {'on' if collecting else 'off'}"))
                print(rows[-1], flush=True)
    if options.write:
        write_page(PAGE, "CPU time of the walking tick", CONDITIONS, [HEAD, *rows])


if __name__ == "__main__":
    main()
