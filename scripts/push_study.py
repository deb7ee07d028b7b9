"""Push a walking robot, or let it track a velocity: the walking engine or a learned policy.

    python scripts/push_study.py pushes --robot t1 --levels 0.15,0.2
    python scripts/push_study.py pushes --robot t1 --delta-v 0.3,0.4 --policy t1_policy.onnx
    python scripts/push_study.py velocity --robot g1 --speeds 0,0.1,0.2

A push acts on the trunk for 50 ms, at a random phase of the gait and from a random side, both drawn
from the seed, while the robot walks forward at 0.1 m/s times its speed scale. A level is the
impulse over m √(g h), with mass m and height h of the centre of mass in the ready posture, or the
change of velocity it causes. Sensors are noisy. ``--policy`` takes a network of MuJoCo Playground,
see `policy_walk`, with the pushes and seeds of the engine. ``--record`` puts the results into a CSV
file, see `measured`. Tune on seeds 0 to 99; the results are from seeds 1000 and above.
"""

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from math import pi, sqrt
from pathlib import Path

from hsr8.errors import Hsr8Error
from hsr8.robots.loaded import LoadedRobot, load_robot
from hsr8.scenario.loader import load_scenario
from hsr8.trials.walk import Trial
from hsr8.world.body.pushes import ScheduledPush
from walking.command import VelocityCommand
from walking.dimension import HSR_VIII, SPEED
from walking.parameters import CONTROL_PERIOD, GRAVITY

import numpy as np
from measured import record
from numpy.typing import NDArray
from policy_walk import PolicyWalker
from study import seeds

Array = NDArray[np.float64]
Walker = Callable[[float, float, int, tuple[ScheduledPush, ...]], tuple[bool, Array]]
"""Walk forward at a speed [m/s] for a duration [s] with a seed and pushes; return whether the robot
fell and its mean velocity (3,) [m/s, m/s, rad/s]."""

WALKING_SPEED = 0.1  # of HSR-VIII while it is pushed [m/s]
PUSH_TIME = 0.05  # duration of a push [s]
WARM_UP = 3.0  # earliest push [s]
WATCHED = 3.0  # time after a push in which a fall counts [s]
TRACKING = 20.0  # duration of a walk of the study `velocity` [s]
STUDIES = {  # and whether pushes are changes of velocity
    ("pushes", False): "J / (m √(g h))",
    ("pushes", True): "Δv [m/s]",
    ("velocity", False): "v [m/s]",
}


@dataclass(frozen=True, slots=True)
class Scale:
    """Physical scale of the pushes on a robot.

    Attributes:
        mass: mass of the robot [kg].
        height: height of its centre of mass in the ready posture [m].
        speed: speed at which it walks [m/s].
    """

    mass: float
    height: float
    speed: float

    @classmethod
    def of(cls, robot: LoadedRobot) -> "Scale":
        """Return the scale of a robot."""
        model = robot.model
        height = robot.height + float(model.com(model.ready)[2])
        speed = SPEED.scale(WALKING_SPEED, HSR_VIII, model.measures())
        return cls(model.mass, height, speed)

    def impulse(self, level: float, *, delta_v: bool) -> float:
        """Return the impulse of a level [N s]."""
        return self.mass * level * (1.0 if delta_v else sqrt(GRAVITY * self.height))


def drawn_push(impulse: float, stride: float, body: str, seed: int) -> ScheduledPush:
    """Return the push of a seed.

    Args:
        impulse: [N s].
        stride: duration of a gait cycle [s].
        body: name of the pushed body.
        seed: draws direction and phase.
    """
    direction, phase = np.random.default_rng([seed, 11]).uniform(size=2).tolist()
    first = round((WARM_UP + phase * stride) / CONTROL_PERIOD)
    ticks = round(PUSH_TIME / CONTROL_PERIOD)
    return ScheduledPush(first, ticks, impulse / PUSH_TIME, 2.0 * pi * direction, body)


def engine_walker(robot: LoadedRobot, settings: list[str], noise: float) -> tuple[Walker, float]:
    """Return the walk of the engine, and the duration of its gait cycle [s]."""
    scenario = load_scenario("walk", [f"robot.model={robot.name}", *settings])
    trial = Trial(robot, scenario.walking, noise)

    def walk(
        speed: float, duration: float, seed: int, pushes: tuple[ScheduledPush, ...]
    ) -> tuple[bool, Array]:
        walked = trial.walk(VelocityCommand(speed, 0.0, 0.0), duration, seed, pushes=pushes)
        return walked.falls > 0, walked.velocity()

    return walk, 2.0 * trial.parameters.gait.footstep_time


def push_robot(
    walker: Walker, stride: float, robot: LoadedRobot, level: float, options: argparse.Namespace
) -> list[int]:
    """Return the seeds of the pushes of a level after which the robot fell."""
    scale, fallen = Scale.of(robot), []
    impulse = scale.impulse(level, delta_v=options.delta_v is not None)
    for seed in options.seeds:
        push = drawn_push(impulse, stride, robot.roles.trunk, seed)
        duration = push.first * CONTROL_PERIOD + PUSH_TIME + WATCHED
        if walker(scale.speed, duration, seed, (push,))[0]:
            fallen.append(seed)
    return fallen


def numbers(text: str) -> list[float]:
    """Return the numbers of a list with commas."""
    return [float(part) for part in text.split(",")]


def main() -> None:
    """Run one of the studies."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", choices=("pushes", "velocity"))
    parser.add_argument("--robot", default="hsr8")
    parser.add_argument("--seeds", type=seeds, default=tuple(range(1000, 1064)), metavar="A:B")
    parser.add_argument("--levels", type=numbers, default=[0.15, 0.2], help="J / (m sqrt(g h))")
    parser.add_argument("--delta-v", type=numbers, help="levels by change of velocity [m/s]")
    parser.add_argument("--speeds", type=numbers, default=[0.0, 0.1, 0.2, 0.4, 0.6, 0.8])
    parser.add_argument("--noise", type=float, default=1.0, help="multiple of the sensor noise")
    parser.add_argument("--record", metavar="FILE", help="CSV file to add the results to")
    parser.add_argument("--policy", metavar="FILE", help="learned policy of T1 or G1 (ONNX)")
    parser.add_argument("--set", action="append", default=[], help="KEY=VALUE of a scenario")
    options = parser.parse_args()
    try:
        robot = load_robot(options.robot)
        if options.policy:
            policy = PolicyWalker(options.policy, robot, options.noise)
            walker, stride = policy.walk, policy.stride
        else:
            walker, stride = engine_walker(robot, options.set, options.noise)
    except Hsr8Error as error:
        parser.exit(2, f"{error}\n")
    walked_by = "policy" if options.policy else "hsr8"
    kind, results = STUDIES[options.study, options.delta_v is not None], []
    for level in _levels(options):
        if options.study == "pushes":
            fallen = push_robot(walker, stride, robot, level, options)
            result = f"{len(options.seeds) - len(fallen)} of {len(options.seeds)}"
            note = f"fell: {','.join(map(str, fallen)) or '-'}"
        else:
            walks = [walker(level, TRACKING, seed, ()) for seed in options.seeds]
            velocity = np.mean([velocity for _, velocity in walks], axis=0)
            fell = sum(fell for fell, _ in walks)
            result = f"{velocity[0]:.2f}" if not fell else f"{fell} of {len(walks)} fell"
            note = f"velocity {velocity.round(3).tolist()}"
        print(f"{robot.name}, {walked_by}, {kind}, {level:g}: {result}; {note}", flush=True)
        results.append((robot.name, walked_by, kind, f"{level:g}", result))
    if options.record:
        record(Path(options.record), results)


def _levels(options: argparse.Namespace) -> list[float]:
    """Return the levels of a study: impulses, changes of velocity, or speeds."""
    levels: list[float] = (
        options.speeds if options.study == "velocity" else options.delta_v or options.levels
    )
    return levels


if __name__ == "__main__":
    main()
