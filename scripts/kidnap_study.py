"""Kidnaps: the robot is put elsewhere without notice; how soon does it know where it is?

Every `interval` seconds the believed pose is replaced by a random one in the field, by a jump
of the odometry that no covariance tells of: to the belief that is the same as if the robot
had been carried from there to where it stands. Body, camera, gaze and walking run on.

    python scripts/kidnap_study.py paper --seeds 1000-1009 --kidnaps 10 --interval 11
"""

import pickle
import sys
from dataclasses import dataclass, field, replace
from math import cos, degrees, hypot, pi, sin
from pathlib import Path
from unittest.mock import patch

from hsr8 import robot_builder
from hsr8.loop import Simulation
from hsr8.recorder.record import Listener, TickRecord
from hsr8.scenario.loader import load_scenario
from hsr8.seeds import named_rng
from hsr8.world.field.generator import draw_layout
from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.belief.estimator import Estimator
from navigation.observation import Frame

import numpy as np
import tyro
from study_page import seeds_of
from tyro.conf import Positional, UseAppendAction

FOUND = 0.10  # position error of a robot that knows where it is [m]
FOUND_TURN = 0.09  # and its heading error [rad]
WRONG = 30.0  # squared Mahalanobis distance from which on a pose is wrong and not uncertain [1]
LIMIT = 10.0  # time within which it shall know [s]


def compose(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Pose `b`, told in the frame of pose `a`, in the frame in which `a` is told."""
    c, s = cos(a[2]), sin(a[2])
    return np.array([a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2]])


def inverse(a: np.ndarray) -> np.ndarray:
    """Pose that undoes `a`."""
    c, s = cos(a[2]), sin(a[2])
    return np.array([-c * a[0] - s * a[1], s * a[0] - c * a[1], -a[2]])


@dataclass
class Carried:
    """An estimator whose robot is carried away every now and then."""

    estimator: Estimator
    interval: float
    kidnaps: int
    rng: np.random.Generator
    times: list[float] = field(default_factory=list)
    belief: Belief | None = None
    _offset: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def update(self, frame: Frame) -> Belief:
        """Belief after `frame`."""
        due = self.interval * (len(self.times) + 1)
        if self.belief is not None and frame.time >= due and len(self.times) < self.kidnaps:
            self.times.append(frame.time)
            place = np.array([*self.rng.uniform(-2.2, 2.2, 2), self.rng.uniform(-pi, pi)])
            jump = compose(inverse(self.belief.pose), place)
            carried = compose(compose(frame.odometry, jump), inverse(frame.odometry))
            self._offset = compose(self._offset, carried)
        odometry = compose(self._offset, frame.odometry)
        self.belief = self.estimator.update(replace(frame, odometry=odometry))
        return self.belief


@dataclass
class Watcher(Listener):
    """Listener that notes when the robot noticed each kidnap, and when it was found again."""

    carried: list[Carried]
    noticed: dict[float, float] = field(default_factory=dict)
    found: dict[float, float] = field(default_factory=dict)
    wrong: int = 0

    def on_record(self, record: TickRecord) -> None:
        """Compare a belief with the truth; frames come without delay here."""
        if record.frame is not None:
            self.note(record.frame.estimate, record.truth.robot)

    def note(self, belief: Belief, robot: np.ndarray) -> None:
        """Compare a belief with the true pose."""
        times = self.carried[0].times
        if not times:
            return
        kidnap = times[-1]
        age = belief.time - kidnap
        if belief.lost:
            self.noticed.setdefault(kidnap, age)
            return
        e = belief.pose - robot
        e[2] = wrap(float(e[2]))
        if hypot(e[0], e[1]) < FOUND and abs(float(e[2])) < FOUND_TURN:
            self.found.setdefault(kidnap, age)
        elif kidnap in self.noticed and e @ np.linalg.solve(belief.pose_covariance, e) > WRONG:
            self.wrong += 1


def main(
    scenario: Positional[str],
    *,
    seeds: str = "0-4",
    kidnaps: int = 5,
    interval: float = 15.0,
    set: UseAppendAction[tuple[str, ...]] = (),
    kept: Path | None = None,
) -> None:
    """Run the study and print its table.

    Args:
        scenario: name or TOML file.
        seeds: as everywhere, 1000-1009 or 1,5,9; 0-99 are for tuning, 1000 and above for reports.
        kidnaps: per run.
        interval: between two of them [s].
        set: settings of the scenario.
        kept: folder of frames that `belief_study.py --keep` left; the walks of then are
            believed anew, and neither gaze nor walking take notice of the kidnaps.
    """
    noticed: list[float] = []
    found: list[float] = []
    total = wrong = 0
    build = robot_builder.build_estimator
    for seed in seeds_of(seeds):
        carried: list[Carried] = []

        def built(*arguments, seed=seed, carried=carried):
            rng = np.random.default_rng([seed, 1])
            carried.append(Carried(build(*arguments), interval, kidnaps, rng))
            return carried[0]

        settings = load_scenario(scenario, [f"duration={interval * (kidnaps + 1)}", *set], seed)
        watcher = Watcher(carried)
        if kept is not None:
            built(settings, draw_layout(settings, seed), named_rng(seed, "belief"))
            for moment in pickle.loads((kept / f"{seed}.pkl").read_bytes()):
                watcher.note(carried[0].update(moment.frame), moment.robot)
        else:
            with patch.object(robot_builder, "build_estimator", built):
                Simulation(settings, seed, [watcher]).run()
        times = carried[0].times
        total += len(times)
        noticed += [watcher.noticed[t] for t in times if t in watcher.noticed]
        found += [watcher.found.get(t, float("inf")) for t in times]
        wrong += watcher.wrong
        late = [round(watcher.found.get(t, float("inf")), 1) for t in times]
        print(f"seed {seed}: found after {late} s", file=sys.stderr, flush=True)
    in_time = sum(t <= LIMIT for t in found)
    quantiles = ", ".join(f"{np.percentile(found, q, method='higher'):.1f}" for q in (50, 90, 95))
    print(f"| {scenario}, seeds {seeds}, {total} kidnaps | |\n|---|---|")
    print(f"| noticed after, median / p90 [s] | {np.median(noticed):.2f} / "
          f"{np.percentile(noticed, 90):.2f} |")  # fmt: skip
    print(f"| pose within {100 * FOUND:.0f} cm and {degrees(FOUND_TURN):.0f} deg after, "
          f"median, p90, p95 [s] | {quantiles} |")  # fmt: skip
    print(f"| within {LIMIT:g} s | {in_time} of {total} |")
    print(f"| frames sure of a wrong pose after having been lost | {wrong} |")


if __name__ == "__main__":
    tyro.cli(main)
