"""Walk in full physics under sensor noise, without vision and navigation, and report how well.

    python scripts/walk_study.py random --seeds 0:20 --duration 120
    python scripts/walk_study.py steady --command 0.2 0 0 --set walking.gait.footstep_time=0.3
    python scripts/walk_study.py profile --robot op3

``random`` changes the command every 0.5 to 2 s within the speed limits of the robot, with stops
and extremes, and moves the head. ``--set`` tries parameters and constants of walking. Tune on seeds
0 to 99; the results are from seeds 1000 and above.
"""

import argparse
import cProfile
import pstats

from hsr8.robots.loaded import LoadedRobot, load_robot
from hsr8.scenario.loader import load_scenario
from hsr8.trials.commands import random_commands, random_head, time_scale
from hsr8.trials.walk import Trial, Walked
from walking.command import VelocityCommand
from walking.parameters import CONTROL_PERIOD

import numpy as np
from numpy.typing import NDArray
from study import seeds

Array = NDArray[np.float64]

WINDOW = 5.0  # over which the odometry drifts [s]


def report(name: str, walk: Walked) -> None:
    """Print falls, tilt, odometry error and error of the camera pose of a walk."""
    stride = round(WINDOW / CONTROL_PERIOD)
    moved, measured = (displacements(poses[::stride]) for poses in (walk.poses, walk.odometry))
    path = np.hypot(*np.diff(walk.poses[::stride, :2], axis=0).T).sum()
    drift = np.hypot(*(measured - moved)[:, :2].T).sum() / max(path, 1e-9)
    tilts = ", ".join(f"{value:.2f}" for value in np.percentile(walk.tilt, (50, 99, 100)))
    tilt, roll, yaw, height = (1e3 * walk.camera.std(axis=0)).tolist()
    print(
        f"{name}: falls {walk.falls}, {walk.steps} steps, tilt p50, p99, max {tilts} deg, "
        f"odometry {100.0 * drift:.1f} cm/m over {WINDOW:g} s, camera pose "
        f"{tilt:.1f}, {roll:.1f}, {yaw:.1f} mrad, {height:.2f} mm",
        flush=True,
    )


def displacements(poses: Array) -> Array:
    """Return the displacements between poses (n, 3), in the heading of the first (n - 1, 3)."""
    d, yaw = np.diff(poses, axis=0), poses[:-1, 2]
    c, s = np.cos(yaw), np.sin(yaw)
    return np.stack([c * d[:, 0] + s * d[:, 1], c * d[:, 1] - s * d[:, 0], d[:, 2]], axis=1)


def random_walk(trial: Trial, robot: LoadedRobot, duration: float, seed: int) -> Walked:
    """Walk under random commands within the speed limits, with a moving head."""
    limits = robot.parameters.limits
    speed = {axis: getattr(limits, axis) for axis in ("vx", "vx_backward", "vy", "wz")}
    commands = random_commands(speed, time_scale(trial.parameters), seed)
    return trial.walk(commands, duration, seed, head=random_head(robot, seed))


def main() -> None:
    """Run one of the studies."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", choices=("random", "steady", "profile"))
    parser.add_argument("--robot", default="hsr8")
    parser.add_argument("--seeds", type=seeds, default=(0,), metavar="A:B")
    parser.add_argument("--duration", type=float, default=60.0, help="of a walk [s]")
    parser.add_argument("--command", type=float, nargs=3, default=(0.1, 0.0, 0.0), help="vx vy wz")
    parser.add_argument("--noise", type=float, default=1.0, help="multiple of the sensor noise")
    parser.add_argument("--set", action="append", default=[], help="KEY=VALUE of a scenario")
    options = parser.parse_args()
    robot = load_robot(options.robot)
    scenario = load_scenario("walk", [f"robot.model={options.robot}", *options.set])
    trial = Trial(robot, scenario.walking, options.noise)
    command = VelocityCommand(*options.command)
    if options.study == "profile":
        trial.walk(command, 1.0)
        with cProfile.Profile() as profile:
            trial.walk(command, 10.0)
        pstats.Stats(profile).sort_stats("tottime").print_stats(25)
        return
    for seed in options.seeds:
        if options.study == "random":
            report(f"seed {seed}", random_walk(trial, robot, options.duration, seed))
        else:
            walk = trial.walk(command, options.duration, seed)
            report(f"seed {seed}, velocity {walk.velocity().round(3).tolist()}", walk)


if __name__ == "__main__":
    main()
