"""Walk any robot in full physics under sensor noise: steady, under random commands, pushed.

    python scripts/robot_study.py op3 t1 g1 apollo

Speeds are fractions of the calibrated envelope (`hsr8 robot calibrate`). A push lasts 50 ms; its
level is J / (m √(g h)) with the impulse J, the mass m and the height h of the equivalent pendulum.
Survived is not to lie 4 s later, in the time scale of HSR-VIII. Each robot prints three tables.
"""

import argparse
from math import pi, sqrt

from hsr8.robots.loaded import LoadedRobot, load_robot
from hsr8.trials.calibration import command_of, random_commands, random_head, time_scale
from hsr8.trials.walk import Trial
from hsr8.world.body.pushes import ScheduledPush
from walking.command import VelocityCommand
from walking.parameters import CONTROL_PERIOD, GRAVITY

import numpy as np

FRACTIONS = (0.25, 0.5, 0.8)
STEADY_TIME, RANDOM_TIME = 20.0, 60.0  # of a walk [s]
RANDOM_SEEDS = range(1000, 1020)
LEVELS = (0.10, 0.15, 0.20)
DIRECTIONS, PHASES = 8, 8  # of pushes; phases of two footsteps
LEAD, AFTER = 3.0, 4.0  # around a push, in the time scale of HSR-VIII [s]
PUSH = 0.05  # duration [s]
WALK = 0.5  # speed of the walk that is pushed, of the envelope [1]


def envelope(robot: LoadedRobot) -> dict[str, float]:
    """Return the calibrated speed limits, or the rehearsed ones without a calibration."""
    limits = robot.parameters.limits
    return {axis: getattr(limits, axis) for axis in ("vx", "vx_backward", "vy", "wz")}


def steady(trial: Trial, speed: dict[str, float]) -> None:
    """Print velocity error and falls in five directions."""
    rows = (("vx", 1), ("vx_backward", 1), ("vy", 1), ("vy", -1), ("wz", 1))
    for axis, sign in rows:
        cells = []
        for fraction in FRACTIONS:
            limit = fraction * speed[axis]
            command = command_of(axis, limit if sign > 0 else -limit)
            walk = trial.walk(command, STEADY_TIME, 1000)
            error = np.abs(walk.velocity() - command.velocity).max() / limit
            cells.append("fell" if walk.falls else f"{error:.1%}")
        name = axis if sign > 0 else f"-{axis}"
        print(f"  {name:12} {speed[axis]:6.3f}  " + "  ".join(f"{c:>6}" for c in cells), flush=True)


def under_random_commands(trial: Trial, speed: dict[str, float]) -> None:
    """Print the number of falls."""
    falls, scale = 0, time_scale(trial.parameters)
    for seed in RANDOM_SEEDS:
        commands, head = random_commands(speed, scale, seed), random_head(trial.robot, seed)
        falls += trial.walk(commands, RANDOM_TIME, seed, head=head).falls
    print(
        f"  random commands: {falls} falls in {len(RANDOM_SEEDS)} x {RANDOM_TIME:.0f} s", flush=True
    )


def pushed(trial: Trial, speed: dict[str, float]) -> None:
    """Print how many pushes are survived at each level."""
    robot, scale = trial.robot, time_scale(trial.parameters)
    momentum = robot.model.mass * sqrt(GRAVITY * robot.model.pendulum_height())
    stride, ticks = 2.0 * trial.parameters.gait.footstep_time, round(PUSH / CONTROL_PERIOD)
    command = VelocityCommand(WALK * speed["vx"])
    for level in LEVELS:
        survived = 0
        for k in range(DIRECTIONS * PHASES):
            direction, phase = divmod(k, PHASES)
            begin = LEAD * scale + stride * phase / PHASES
            push = ScheduledPush(
                first=round(begin / CONTROL_PERIOD),
                ticks=ticks,
                force=level * momentum / (ticks * CONTROL_PERIOD),
                direction=2.0 * pi * direction / DIRECTIONS,
                body=robot.roles.trunk,
            )
            walk = trial.walk(command, begin + AFTER * scale, 1000 + k, pushes=(push,))
            survived += not walk.falls
        print(f"  pushes of {level:.2f}: {survived} of {DIRECTIONS * PHASES}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("robots", nargs="+", help="names or description files")
    parser.add_argument("--only", choices=["steady", "random", "pushes"], help="one table")
    options = parser.parse_args()
    parts = {"steady": steady, "random": under_random_commands, "pushes": pushed}
    for name in options.robots:
        robot = load_robot(name)
        trial, speed = Trial(robot), envelope(robot)
        print(name, flush=True)
        for part, table in parts.items():
            if options.only in (None, part):
                table(trial, speed)


if __name__ == "__main__":
    main()
