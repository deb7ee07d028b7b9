"""Gaze and planner in a 2-D closed loop without MuJoCo and images.

The worlds are those of a scenario. The outline of the walking body moves with commands that are
latched per footstep and slip. Sensing is `perfect` (true poses and velocities) or `camera` (the
estimator with a simulated head camera). A run ends at its first contact.

    python scripts/decision_study.py course --first 1000 --runs 100
    python scripts/decision_study.py course --settings navigation.gaze.mode=sweep
"""

import json
from dataclasses import dataclass, field
from math import atan2, cos, degrees, hypot, pi
from pathlib import Path
from time import perf_counter, process_time
from typing import Annotated, Literal

from hsr8.evaluation.proportion import Proportion
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.world.field.generator import draw_layout
from navigation.angles import wrap
from navigation.baselines.choice import build_planner
from navigation.belief.belief import Belief
from navigation.belief.estimator import Estimator
from navigation.decision import MotionDecision, Task
from navigation.gaze.planner import GazePlanner
from navigation.mission import Mission
from navigation.observation import Frame

import numpy as np
import tyro
from belief_world import CAMERA_HEIGHT, HFOV, VFOV, Camera, view
from decision_world import TICK, Walker, World, perfect_belief
from numpy.typing import NDArray

Array = NDArray[np.float64]

HEAD_SPEED = 6.0  # [rad/s]
CLOSE = 0.10  # [m]


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
    close: float
    """Time with a mover nearer to the body than `CLOSE` [s]."""
    travel: float
    """Travel of the head in pan [rad]."""
    cause: dict[str, object] = field(default_factory=dict)
    plan_ms: float = 0.0
    gaze_ms: float = 0.0


class Run:
    """One run of the closed loop."""

    def __init__(self, scenario: Scenario, seed: int, sensing: str) -> None:
        streams = [np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(5)]
        self.seed, self.sensing = seed, sensing
        self.world = World(draw_layout(scenario, seed))
        layout, limits = self.world.layout, scenario.speed_limits()
        parameters = scenario.navigation
        self.duration, self.step_ticks = scenario.duration, round(limits.footstep / TICK)
        self.walker = Walker(np.array(layout.start), limits, streams[1])
        self.mission = Mission(
            layout.waypoints, layout.goal_heading, layout.endless, parameters.mission
        )
        self.planner = build_planner(parameters, limits, streams[4])
        self.gaze = GazePlanner(parameters, limits, self.world.beacons, HFOV, VFOV)
        self.omnidirectional = scenario.camera.omnidirectional
        self.fov = 2.0 * pi if self.omnidirectional else HFOV
        self.period = scenario.camera.period_ms / 1000
        self.frame_ticks = round(self.period / TICK)
        self.camera = Camera(streams[2], self.fov, self.period)
        start = np.array(layout.start) + streams[2].normal(0.0, 0.02, 3)
        self.estimator = Estimator(
            scenario.belief, self.world.beacons, start, np.eye(3) * 4e-4, streams[3]
        )
        self.head, self.target = np.array([0.0, -0.45]), np.array([0.0, -0.45])
        self.close = self.travel = 0.0
        self.times: dict[str, list[float]] = {"plan": [0.0], "gaze": [0.0]}
        self.motion: MotionDecision | None = None
        self.history: list[tuple[float, Array, Array, Belief]] = []

    def run(self) -> Episode:
        """Walk until done, a contact or the time limit."""
        world, walker = self.world, self.walker
        clearance = 9.0
        belief: Belief | None = None
        task: Task | None = None
        for tick in range(round(self.duration / TICK)):
            time = tick * TICK
            if self.sensing == "camera":
                self.turn_head()
            if tick % self.frame_ticks == 0:
                belief = self.sense(time)
                task = self.mission.update(belief.pose)
                self.look(belief, task)
            assert belief is not None
            assert task is not None
            if task.done:
                return self._end("goal", time, clearance, task)
            if tick % self.step_ticks == 0:
                begin = process_time()
                self.motion = self.planner.plan(belief, task)
                self.times["plan"].append(process_time() - begin)
                walker.latch(self.motion.velocity)
                self.history.append((time, walker.pose.copy(), self.motion.velocity, belief))
            walker.step()
            gaps = world.gaps(time + TICK, walker.pose)
            clearance = min(clearance, float(gaps.min()))
            movers = gaps[len(world.layout.static) :]
            self.close += TICK * float(movers.min(initial=9.0) < CLOSE)
            if clearance < 0.0:
                episode = self._end("contact", time, clearance, task)
                episode.cause = self._cause(int(gaps.argmin()), belief, time)
                return episode
        assert task is not None
        return self._end("timeout", self.duration, clearance, task)

    def turn_head(self) -> None:
        """Turn the head towards the target for one tick."""
        step = HEAD_SPEED * TICK
        turn = np.clip(self.target - self.head, -step, step)
        self.head += turn
        self.travel += abs(float(turn[0]))

    def sense(self, time: float) -> Belief:
        """Return the belief of this frame."""
        if self.sensing == "perfect":
            pose = self.walker.pose.copy()
            pose[2] = wrap(float(pose[2]))
            return perfect_belief(time, pose, self.world)
        pan, tilt = self.head.tolist()
        positions, _ = self.world.state(time)
        cylinders = [
            ("obstacle", o.color, p, o.radius)
            for o, p in zip(self.world.layout.obstacles, positions, strict=True)
            if self._in_tilt(p, tilt, pan, 0.0, 0.30)
        ]
        cylinders += [
            ("beacon", name, np.array(p), 0.05)
            for name, p in self.world.beacons.items()
            if self._in_tilt(np.array(p), tilt, pan, 0.25, 0.35)
        ]
        observations = self.camera.observe(time, self.walker.pose, pan, cylinders)
        return self.estimator.update(
            Frame(
                time,
                self.walker.odometry.copy(),
                self.walker.motion_covariance(self.period),
                view(pan, tilt, self.fov),
                observations,
            )
        )

    def _in_tilt(self, point: Array, tilt: float, pan: float, low: float, high: float) -> bool:
        """Return whether part of a cylinder is within the vertical field of view."""
        if self.omnidirectional:
            return True
        dx, dy = (point - self.walker.pose[:2]).tolist()
        off = wrap(atan2(dy, dx) - float(self.walker.pose[2]) - pan)
        depth = max(0.05, hypot(dx, dy) * max(0.2, cos(off)))
        bottom, top = atan2(low - CAMERA_HEIGHT, depth), atan2(high - CAMERA_HEIGHT, depth)
        return bottom < tilt + 0.5 * VFOV - 0.02 and top > tilt - 0.5 * VFOV + 0.02

    def look(self, belief: Belief, task: Task) -> None:
        """Choose the gaze."""
        if self.sensing == "perfect":
            return
        begin = process_time()
        decision = self.gaze.choose(belief, task, self.motion)
        self.times["gaze"].append(process_time() - begin)
        self.target = np.array([decision.pan, decision.tilt])

    def _end(self, reason: str, time: float, clearance: float, task: Task) -> Episode:
        pose = self.walker.pose
        layout = self.world.layout
        position = float(np.hypot(*(pose[:2] - layout.waypoints[-1])))
        wanted = float(pose[2]) if layout.goal_heading is None else layout.goal_heading
        heading = abs(wrap(float(pose[2]) - wanted))
        return Episode(
            self.seed,
            reason == "goal" and position < 0.10 and heading < 0.26,
            reason,
            round(time, 2),
            task.index,
            round(clearance, 3),
            round(position, 3),
            round(degrees(heading), 1),
            round(self.close, 2),
            round(self.travel, 1),
            plan_ms=1e3 * float(np.mean(self.times["plan"])),
            gaze_ms=1e3 * float(np.mean(self.times["gaze"])),
        )

    def _cause(self, index: int, belief: Belief, time: float) -> dict[str, object]:
        """Return the belief about the obstacle it hit, and the circumstances."""
        obstacle = self.world.layout.obstacles[index]
        pose, body = self.walker.pose, self.walker.body
        position, velocity = (a[index] for a in self.world.state(time))
        bearing = wrap(atan2(*(position - pose[:2])[::-1].tolist()) - float(pose[2]))
        looks = []
        for back in (2.0, 1.0, 0.0):
            then = [h for h in self.history if h[0] <= time - back]
            if not then:
                continue
            known = then[-1][3] if back else belief
            truth, true_velocity = (a[index] for a in self.world.state(known.time))
            same = [t for t in known.tracks if t.label == obstacle.color]
            best = min(same, key=lambda t: float(np.hypot(*(t.position - truth))), default=None)
            if best is None:
                looks.append("none")
            else:
                off = float(np.hypot(*(best.position - truth)))
                speed_off = float(np.hypot(*(best.velocity - true_velocity)))
                cloud = "*" if best.particles is not None else ""
                looks.append(
                    f"{best.motion}{cloud} age {best.age:.1f} off {off:.2f} v {speed_off:.2f}"
                )
        pose_error = float(np.hypot(*(belief.pose[:2] - pose[:2])))
        return {
            "moving": obstacle.motion is not None,
            "speed": round(float(np.hypot(*velocity)), 3),
            "bearing": round(degrees(bearing)),
            "robot_speed": round(hypot(body[0], body[1]), 3),
            "head_on": round(float(velocity @ (pose[:2] - position)) / 0.2, 2),
            "known": looks,
            "pose_error": round(pose_error, 3),
        }


def main(
    scenario: Annotated[str, tyro.conf.Positional] = "course",
    *,
    sensing: Literal["perfect", "camera"] = "camera",
    first: int = 0,
    runs: int = 20,
    settings: tuple[str, ...] = (),
    out: Path | None = None,
    quiet: bool = False,
) -> None:
    """Run the study and print its summary.

    Args:
        scenario: name or file.
        sensing: perfect, or by camera.
        first: first seed; 0-99 are for tuning, 1000 and above for reports.
        runs: number of seeds.
        settings: changed settings, like navigation.safety_filter.margin=0.04.
        out: file for one JSON line per run.
        quiet: do not print failures.
    """
    episodes = []
    begin = perf_counter()
    for seed in range(first, first + runs):
        episode = Run(load_scenario(scenario, settings, seed), seed, sensing).run()
        episodes.append(episode)
        if not episode.success and not quiet:
            print(episode, flush=True)
        if out is not None:
            with out.open("a") as file:
                file.write(json.dumps(vars(episode), default=str) + "\n")
    n = len(episodes)
    good = [e for e in episodes if e.success]
    interval = Proportion.counted(len(good), n)
    count = {r: sum(e.reason == r for e in episodes) for r in ("contact", "timeout", "goal")}
    hit = sum(bool(e.cause.get("moving")) for e in episodes)
    times = [e.time for e in good] or [0.0]
    print(
        f"{scenario} {sensing} seeds {first}-{first + n - 1} {settings}\n"
        f"  success {len(good)}/{n} = {100 * len(good) / n:.1f} % [{100 * interval.low:.0f}, "
        f"{100 * interval.high:.0f}]  contacts {count['contact']} (movers {hit})  "
        f"timeouts {count['timeout']}  "
        f"missed arrival {count['goal'] - len(good)}\n"
        f"  time median {np.median(times):.0f} s, 90 % {np.percentile(times, 90):.0f} s; "
        f"arrival error mean {np.mean([e.position_error for e in good] or [0]):.3f} m, "
        f"{np.mean([e.heading_error for e in good] or [0]):.1f} deg; "
        f"plan {np.mean([e.plan_ms for e in episodes]):.2f} ms, "
        f"gaze {np.mean([e.gaze_ms for e in episodes]):.2f} ms; movers close for "
        f"{np.mean([e.close for e in episodes]):.1f} s a run; head "
        f"{np.sum([e.travel for e in episodes]) / np.sum([e.time for e in episodes]):.2f} rad/s; "
        f"{(perf_counter() - begin) / n:.1f} s per run"
    )


if __name__ == "__main__":
    tyro.cli(main)
