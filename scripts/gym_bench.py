"""Environment against native runs: the same decisions, state hashes, and decisions per second.

    python scripts/gym_bench.py [--runs 10] [--set robot.body=full]

Each seed runs natively, with a gaze plugin, and in ``hsr8/Gaze-v0``, in turn; times are processor
time, which other work on the machine changes less than wall time.
"""

import argparse
from math import sin
from time import process_time

import hsr8
import hsr8.gym
from navigation.decision import GazeDecision

import gymnasium
import numpy as np

FAST = ["robot.body=kinematic", "camera.source=analytic"]
TILT = -0.4  # [rad]


class Scripted:
    """Gaze that swings with the number of frames."""

    def __init__(self) -> None:
        self.frames = 0

    def pan(self) -> float:
        """Return the next pan [rad]."""
        self.frames += 1
        return sin(0.1 * self.frames)

    def choose(self, belief: object, task: object, motion: object) -> GazeDecision:
        """Return the gaze of the next frame."""
        return GazeDecision(self.pan(), TILT)


def main() -> None:
    """Print a line per seed and the totals."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--set", nargs="*", default=[], dest="settings")
    args = parser.parse_args()
    settings = [*FAST, "duration=30", *args.settings]
    options = {"settings": settings, "normalized": False, "end_on_contact": False}
    env = gymnasium.make("hsr8.gym:hsr8/Gaze-v0", scenario="crowd", **options)
    hsr8.run("crowd", settings=[*settings, "duration=1"])  # compiles the kernels
    times, equal = np.zeros(2), 0
    for seed in range(args.runs):
        began = process_time()
        native = hsr8.run("crowd", seed=seed, settings=settings, gaze=Scripted()).metrics
        middle = process_time()
        scripted, ended = Scripted(), False
        env.reset(seed=seed)
        while not ended:
            *_, terminated, truncated, info = env.step(np.array([scripted.pan(), TILT]))
            ended = terminated or truncated
        taken = np.array([middle - began, process_time() - middle])
        same = info["metrics"]["state_hash"] == native["state_hash"]
        times, equal = times + taken, equal + same
        rates = native["camera_frames"] / taken
        print(f"seed {seed}: {rates[0]:.0f} and {rates[1]:.0f} decisions per second, equal {same}")
    print(f"equal runs: {equal} of {args.runs}; environment / native: {times[0] / times[1]:.3f}")


if __name__ == "__main__":
    main()
