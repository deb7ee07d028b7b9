"""Decision study: gaze and planner in a 2-D closed loop without MuJoCo and pixels.

A disc of the robot's width walks with footstep-latched, slipping commands through four
via points to a goal with an arrival heading, among 12 still and 4 shuttling cylinders.
Sensing is `perfect` (true poses and velocities) or `camera` (the estimator fed by a
simulated head camera that sees what the gaze shows it). A run ends at its first contact.

    python scripts/decision_study.py --profile extended --sensing camera --first 1000 --runs 100
"""

import json
from dataclasses import dataclass, field, replace
from math import atan2, cos, degrees, hypot
from pathlib import Path
from time import perf_counter
from typing import Literal

import numpy as np
import tyro
from belief_world import BEACONS, FRAME, HFOV, VFOV, Camera, view
from decision_world import LIMITS, S_ROBOT, STEP_TICKS, TICK, Walker, draw_world, perfect_belief
from numpy.typing import NDArray
from wilson import wilson

from navigation.angles import wrap
from navigation.belief import Belief
from navigation.belief_parameters import BeliefParameters
from navigation.decision import MotionDecision, Task
from navigation.decision_parameters import NavigationParameters
from navigation.estimator import Estimator
from navigation.gaze import GazePlanner
from navigation.mission import Mission
from navigation.observation import Frame
from navigation.planner import Planner

Array = NDArray[np.float64]

FRAME_TICKS = 3
TIME_LIMIT = 240.0  # [s]
HEAD_SPEED = 6.0  # [rad/s]


@dataclass
class Episode:
    """Outcome of one run."""

    seed: int
    success: bool
    reason: str
    time: float
    via: int
    clearance: float
    position_error: float
    heading_error: float
    cause: dict[str, object] = field(default_factory=dict)
    plan_ms: float = 0.0
    gaze_ms: float = 0.0


class Run:
    """One closed loop."""

    def __init__(
        self,
        seed: int,
        parameters: NavigationParameters,
        sensing: str,
        movers: int,
        ratio: tuple[float, float],
    ) -> None:
        streams = [np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(4)]
        self.seed, self.sensing = seed, sensing
        self.world = draw_world(streams[0], 12, movers, ratio)
        self.walker = Walker(self.world.start, streams[1])
        self.mission = Mission(
            self.world.waypoints, self.world.goal_heading, False, parameters.mission
        )
        self.planner = Planner(parameters, LIMITS)
        self.gaze = GazePlanner(parameters, LIMITS, BEACONS, HFOV, VFOV)
        self.camera = Camera(streams[2])
        start = self.world.start + streams[2].normal(0.0, 0.02, 3)
        self.estimator = Estimator(BeliefParameters(), BEACONS, start, np.eye(3) * 4e-4, streams[3])
        self.head, self.target = np.array([0.0, -0.45]), np.array([0.0, -0.45])
        self.times: dict[str, list[float]] = {"plan": [0.0], "gaze": [0.0]}
        self.motion: MotionDecision | None = None
        self.history: list[tuple[float, Array, Array, Belief]] = []

    def run(self) -> Episode:
        """Walk until done, a contact or the time limit."""
        world, walker = self.world, self.walker
        radii = np.array([o.radius for o in world.obstacles])
        clearance = 9.0
        belief: Belief | None = None
        task: Task | None = None
        for tick in range(round(TIME_LIMIT / TICK)):
            time = tick * TICK
            if self.sensing == "camera":
                step = HEAD_SPEED * TICK
                self.head += np.clip(self.target - self.head, -step, step)
            if tick % FRAME_TICKS == 0:
                belief = self._sense(time)
                task = self.mission.update(belief.pose)
                self._look(belief, task)
            assert belief is not None
            assert task is not None
            if task.done:
                return self._end("goal", time, clearance, task)
            if tick % STEP_TICKS == 0:
                begin = perf_counter()
                self.motion = self.planner.plan(belief, task)
                self.times["plan"].append(perf_counter() - begin)
                walker.latch(self.motion.velocity)
                self.history.append((time, walker.pose.copy(), self.motion.velocity, belief))
            walker.step()
            positions, _ = world.state(time + TICK)
            gaps = np.hypot(*(positions - walker.pose[:2]).T) - radii - S_ROBOT
            clearance = min(clearance, float(gaps.min()))
            if clearance < 0.0:
                episode = self._end("contact", time, clearance, task)
                episode.cause = self._cause(int(gaps.argmin()), belief, time)
                return episode
        assert task is not None
        return self._end("timeout", TIME_LIMIT, clearance, task)

    def _sense(self, time: float) -> Belief:
        if self.sensing == "perfect":
            pose = self.walker.pose.copy()
            pose[2] = wrap(float(pose[2]))
            return perfect_belief(time, pose, self.world)
        pan, tilt = self.head.tolist()
        positions, _ = self.world.state(time)
        things = [
            ("obstacle", o.label, p, o.radius)
            for o, p in zip(self.world.obstacles, positions, strict=True)
            if self._in_tilt(p, tilt, pan, 0.0, 0.30)
        ]
        things += [
            ("beacon", name, np.array(p), 0.05)
            for name, p in BEACONS.items()
            if self._in_tilt(np.array(p), tilt, pan, 0.25, 0.35)
        ]
        seen = self.camera.observe(time, self.walker.pose, pan, things)
        return self.estimator.update(
            Frame(
                time,
                self.walker.odometry.copy(),
                self.walker.motion_covariance(FRAME),
                view(pan, tilt),
                seen,
            )
        )

    def _in_tilt(self, point: Array, tilt: float, pan: float, low: float, high: float) -> bool:
        """Whether part of a cylinder is within the image's height."""
        dx, dy = (point - self.walker.pose[:2]).tolist()
        off = wrap(atan2(dy, dx) - float(self.walker.pose[2]) - pan)
        depth = max(0.05, hypot(dx, dy) * max(0.2, cos(off)))
        bottom, top = atan2(low - 0.47, depth), atan2(high - 0.47, depth)
        return bottom < tilt + 0.5 * VFOV - 0.02 and top > tilt - 0.5 * VFOV + 0.02

    def _look(self, belief: Belief, task: Task) -> None:
        if self.sensing == "perfect":
            return
        begin = perf_counter()
        decision = self.gaze.choose(belief, task, self.motion)
        self.times["gaze"].append(perf_counter() - begin)
        self.target = np.array([decision.pan, decision.tilt])

    def _end(self, reason: str, time: float, clearance: float, task: Task) -> Episode:
        pose = self.walker.pose
        position = float(np.hypot(*(pose[:2] - self.world.waypoints[-1])))
        heading = abs(wrap(float(pose[2]) - self.world.goal_heading))
        return Episode(
            self.seed,
            reason == "goal" and position < 0.10 and heading < 0.26,
            reason,
            round(time, 2),
            task.index,
            round(clearance, 3),
            round(position, 3),
            round(degrees(heading), 1),
            plan_ms=1e3 * float(np.mean(self.times["plan"])),
            gaze_ms=1e3 * float(np.mean(self.times["gaze"])),
        )

    def _cause(self, index: int, belief: Belief, time: float) -> dict[str, object]:
        """What the robot knew of what it touched."""
        obstacle = self.world.obstacles[index]
        pose, body = self.walker.pose, self.walker.body
        position, velocity = obstacle.state(time)
        bearing = wrap(atan2(*(position - pose[:2])[::-1].tolist()) - float(pose[2]))
        looks = []
        for back in (2.0, 1.0, 0.0):
            then = [h for h in self.history if h[0] <= time - back]
            if not then:
                continue
            known = then[-1][3] if back else belief
            truth = obstacle.state(known.time)[0]
            same = [t for t in known.tracks if t.label == obstacle.label]
            best = min(same, key=lambda t: float(np.hypot(*(t.position - truth))), default=None)
            if best is None:
                looks.append("none")
            else:
                off = float(np.hypot(*(best.position - truth)))
                speed_off = float(np.hypot(*(best.velocity - obstacle.state(known.time)[1])))
                cloud = "*" if best.particles is not None else ""
                looks.append(
                    f"{best.motion}{cloud} age {best.age:.1f} off {off:.2f} v {speed_off:.2f}"
                )
        pose_error = float(np.hypot(*(belief.pose[:2] - pose[:2])))
        return {
            "moving": obstacle.speed > 0,
            "speed": round(obstacle.speed, 3),
            "bearing": round(degrees(bearing)),
            "robot_speed": round(hypot(body[0], body[1]), 3),
            "head_on": round(float(velocity @ (pose[:2] - position)) / 0.2, 2),
            "known": looks,
            "pose_error": round(pose_error, 3),
        }


def override(parameters: NavigationParameters, settings: tuple[str, ...]) -> NavigationParameters:
    """Apply settings like ``filter.margin=0.04``."""
    for setting in settings:
        path, _, text = setting.partition("=")
        *groups, name = path.split(".")
        chain = [parameters]
        for group in groups:
            chain.append(getattr(chain[-1], group))
        old = getattr(chain[-1], name)
        value = text == "true" if isinstance(old, bool) else type(old)(text)
        new = replace(chain[-1], **{name: value})
        for owner, group in zip(reversed(chain[:-1]), reversed(groups), strict=True):
            new = replace(owner, **{group: new})
        parameters = new
    return parameters


def main(
    *,
    profile: Literal["paper", "extended"] = "extended",
    sensing: Literal["perfect", "camera"] = "perfect",
    first: int = 0,
    runs: int = 20,
    movers: int = 4,
    ratio: tuple[float, float] = (0.3, 0.7),
    settings: tuple[str, ...] = (),
    out: Path | None = None,
    quiet: bool = False,
) -> None:
    """Run the study and print its summary.

    Args:
        profile: parameters to start from.
        sensing: what the robot knows.
        first: first seed; 0-99 are for tuning, 1000 and above for reports.
        runs: number of seeds.
        movers: number of moving obstacles.
        ratio: their speeds, as a ratio to the robot's.
        settings: changed parameters, like filter.margin=0.04.
        out: file for one JSON line per run.
        quiet: do not print failures as they come.
    """
    parameters = getattr(NavigationParameters, profile)()
    parameters = override(parameters, settings)
    episodes = []
    begin = perf_counter()
    for seed in range(first, first + runs):
        episode = Run(seed, parameters, sensing, movers, ratio).run()
        episodes.append(episode)
        if not episode.success and not quiet:
            print(episode, flush=True)
        if out is not None:
            with out.open("a") as file:
                file.write(json.dumps(vars(episode), default=str) + "\n")
    n = len(episodes)
    good = [e for e in episodes if e.success]
    low, high = wilson(len(good), n)
    count = {r: sum(e.reason == r for e in episodes) for r in ("contact", "timeout", "goal")}
    hit = sum(bool(e.cause.get("moving")) for e in episodes)
    times = [e.time for e in good] or [0.0]
    print(
        f"{profile} {sensing} seeds {first}-{first + n - 1} {movers} movers x {ratio} {settings}\n"
        f"  success {len(good)}/{n} = {100 * len(good) / n:.1f} % [{100 * low:.0f}, "
        f"{100 * high:.0f}]  contacts {count['contact']} (movers {hit})  "
        f"time-outs {count['timeout']}  "
        f"missed arrival {count['goal'] - len(good)}\n"
        f"  time median {np.median(times):.0f} s, 90 % {np.percentile(times, 90):.0f} s; "
        f"arrival error mean {np.mean([e.position_error for e in good] or [0]):.3f} m, "
        f"{np.mean([e.heading_error for e in good] or [0]):.1f} deg; "
        f"plan {np.mean([e.plan_ms for e in episodes]):.2f} ms, "
        f"gaze {np.mean([e.gaze_ms for e in episodes]):.2f} ms; "
        f"{(perf_counter() - begin) / n:.1f} s per run"
    )


if __name__ == "__main__":
    tyro.cli(main)
