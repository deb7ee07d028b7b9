"""Tune every baseline planner with the same budget, in a planar loop.

Each baseline gets `candidates` parameter sets, the first by hand and the others drawn, on
`seeds` worlds; the best `finalists` get `more` worlds, and the best over all of them wins.
The score of a run is the fraction of its legs without a collision, 1 for a success. The worlds are
the course with twice its movers. Sensing is without a camera but not perfect: correlated
errors of pose, positions and velocities, velocities that lag, and no sight beyond 2.5 m.

    python scripts/tune_baselines.py tune --out runs/baselines
    python scripts/tune_baselines.py compare --out runs/baselines --first 1000 --runs 40
"""

import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from time import process_time
from typing import Any

from hsr8.evaluation.proportion import Proportion
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.world.field.generator import draw_layout
from navigation.angles import wrap
from navigation.baselines.choice import build_planner
from navigation.belief.belief import Belief
from navigation.mission import Mission

import numpy as np
import tyro
from decision_world import TICK, Walker, World, perfect_belief
from numpy.typing import NDArray

Array = NDArray[np.float64]

TUNING = ("world.n_moving=8",)
POSITION_SIGMA, VELOCITY_SIGMA, ERROR_TIME = 0.02, 0.02, 1.0  # [m], [m/s], [s]
POSE_SIGMA = np.array([0.012, 0.012, 0.015])  # [m, m, rad]
VELOCITY_LAG, SIGHT = 0.6, 2.5  # [s], [m]

# Parameter: smallest value, value by hand, largest; drawn uniformly in the logarithm.
RANGES: dict[str, dict[str, tuple[float, float, float]]] = {
    "univector-plain": {
        "margin": (0.02, 0.05, 0.1), "eta_vo": (0.1, 0.5, 1.5), "d_e": (0.08, 0.2, 0.4),
        "d_b": (0.1, 0.25, 0.6), "k_r": (0.1, 0.3, 0.5),
    },
    "n-posture": {
        "margin": (0.02, 0.05, 0.1), "gain": (1.0, 2.0, 8.0), "offset": (0.05, 0.25, 0.4),
        "lead": (0.2, 1.0, 3.0), "d_min": (0.01, 0.05, 0.15), "delta": (0.05, 0.15, 0.3),
    },
    "apf": {
        "margin": (0.02, 0.05, 0.1), "influence": (0.15, 0.45, 0.8), "gain": (0.005, 0.02, 0.2),
        "reaction": (0.3, 0.8, 3.0), "swirl": (0.1, 0.6, 2.0),
    },
    "orca": {
        "margin": (0.02, 0.05, 0.1), "horizon": (2.0, 5.0, 10.0),
        "static_horizon": (0.8, 2.0, 5.0),
    },
    "dwa": {
        "margin": (0.02, 0.05, 0.1), "horizon": (1.5, 3.0, 6.0),
        "heading_weight": (0.1, 0.3, 1.0), "clearance_weight": (0.1, 0.4, 2.0),
        "clearance": (0.08, 0.25, 0.4), "contact_weight": (2.0, 6.0, 20.0),
    },
    "mppi": {
        "margin": (0.02, 0.05, 0.1), "spread": (0.2, 0.5, 1.0), "persistence": (0.5, 0.8, 0.95),
        "temperature": (0.01, 0.05, 0.3), "heading_weight": (0.05, 0.2, 1.0),
        "clearance_weight": (0.1, 0.5, 2.0), "clearance": (0.08, 0.15, 0.4),
        "contact_weight": (2.0, 8.0, 20.0),
    },
}  # fmt: skip

TUNING_HEAD = """\
| planner | score by hand | tuned | successes by hand | tuned | time by hand [s] | tuned | values |
|---|---|---|---|---|---|---|---|"""
COMPARISON_HEAD = """\
| scenario | planner | successes | % [95 %] | contacts | timeouts | median time [s] | median \
clearance [cm] | CPU per decision [ms] |
|---|---|---|---|---|---|---|---|---|"""

Settings = dict[str, float]
Ranges = Mapping[str, tuple[float, float, float]]
Row = dict[str, Any]


class Blurred:
    """A run with errors of sensing instead of a camera, thinned out to be fast."""

    def __init__(self, scenario: Scenario, seed: int) -> None:
        streams = [np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(5)]
        layout, limits = draw_layout(scenario, seed), scenario.speed_limits()
        parameters = scenario.navigation
        self.seed, self.duration, self.world = seed, scenario.duration, World(layout)
        self.walker = Walker(np.array(layout.start), limits, streams[1])
        self.mission = Mission(
            layout.waypoints, layout.goal_heading, layout.endless, parameters.mission
        )
        self.planner = build_planner(parameters, limits, streams[4])
        self.step_ticks = round(limits.footstep / TICK)
        self.frame_ticks = round(scenario.camera.period_ms / 1000 / TICK)
        self._rng = np.random.default_rng(np.random.SeedSequence([seed, 7]))
        n = len(self.world.radii)
        self._position = POSITION_SIGMA * self._rng.standard_normal((n, 2))
        self._speed = VELOCITY_SIGMA * self._rng.standard_normal((n, 2))
        self._pose = POSE_SIGMA * self._rng.standard_normal(3)
        self._lagged = self.world.state(0.0)[1]

    def outcome(self) -> Row:
        """Walk to the end; how it ended."""
        total = len(self.world.layout.waypoints)
        walker, belief, task = self.walker, None, None
        clearance = 9.0
        begin, planned, calls = process_time(), 0.0, 0
        reason, time = "timeout", self.duration
        for tick in range(round(self.duration / TICK)):
            if tick % self.frame_ticks == 0:
                clearance = min(clearance, float(self.world.gaps(tick * TICK, walker.pose).min()))
                task = self.mission.update(walker.pose + self._pose)
                if clearance < 0.0 or task.done:
                    reason, time = ("goal" if clearance >= 0.0 else "contact"), tick * TICK
                    break
            if tick % self.step_ticks == 0:
                belief = self._blurred(tick * TICK)
                task = self.mission.update(belief.pose)
                before = process_time()
                motion = self.planner.plan(belief, task)
                planned, calls = planned + process_time() - before, calls + 1
                walker.latch(motion.velocity)
            walker.step()
        assert task is not None
        success = reason == "goal"
        return {
            "seed": self.seed,
            "success": success,
            "reason": reason,
            "score": 1.0 if success else min(task.index, total - 1) / total,
            "time": round(time, 2),
            "clearance": round(clearance, 3),
            "plan_ms": round(1e3 * planned / max(1, calls), 3),
            "cpu_s": round(process_time() - begin, 2),
        }

    def _blurred(self, time: float) -> Belief:
        """Return the belief one footstep after the previous call."""
        dt = self.step_ticks * TICK
        keep = float(np.exp(-dt / ERROR_TIME))
        fresh = float(np.sqrt(1.0 - keep**2))
        normal = self._rng.standard_normal
        self._position = keep * self._position + fresh * POSITION_SIGMA * normal(
            self._position.shape
        )
        self._speed = keep * self._speed + fresh * VELOCITY_SIGMA * normal(self._speed.shape)
        self._pose = keep * self._pose + fresh * POSE_SIGMA * normal(3)
        lag = float(np.exp(-dt / VELOCITY_LAG))
        self._lagged = lag * self._lagged + (1.0 - lag) * self.world.state(time)[1]
        pose = self.walker.pose + self._pose
        pose[2] = wrap(float(pose[2]))
        truth = perfect_belief(time, pose, self.world)
        moving = np.array([t.motion.value == "moving" for t in truth.tracks])
        tracks = []
        for index, track in enumerate(truth.tracks):
            away = track.position - self.walker.pose[:2]
            if float(np.hypot(*away)) > SIGHT:
                continue
            velocity = (self._lagged + self._speed)[index] * moving[index]
            position = track.position + self._position[index]
            tracks.append(replace(track, position=position, velocity=velocity, last_seen=position))
        return replace(truth, tracks=tuple(tracks))


def section(method: str) -> str:
    """Name of a baseline's section."""
    return method.replace("-", "_")


def drawn(ranges: Ranges, count: int, rng: np.random.Generator) -> Iterator[Settings]:
    """The values by hand, then `count` - 1 sets drawn from the ranges."""
    yield {name: hand for name, (_, hand, _) in ranges.items()}
    for _ in range(count - 1):
        yield {
            name: float(f"{np.exp(rng.uniform(np.log(low), np.log(high))):.3g}")
            for name, (low, _, high) in ranges.items()
        }


@cache
def base(scenario: str, settings: tuple[str, ...]) -> Scenario:
    return load_scenario(scenario, settings)


def walk(
    method: str, seed: int, *, scenario: str = "course", settings: tuple[str, ...] = ()
) -> Row:
    """One run of a planner."""
    chosen = (f"navigation.planner.method={method}", *settings)
    return {"method": method, **Blurred(base(scenario, chosen), seed).outcome()}


def lines(method: str, values: Settings) -> tuple[str, ...]:
    """Settings of a scenario for these values of a baseline's parameters."""
    return tuple(
        f"constants.navigation.planner.{section(method)}.{k}={v}" for k, v in values.items()
    )


def mean(rows: list[Row]) -> tuple[float, float]:
    """Mean score, and the mean time of successes as a tie-break, less is better."""
    times = [r["time"] for r in rows if r["success"]] or [999.0]
    return float(np.mean([r["score"] for r in rows])), -float(np.mean(times))


def tune(
    *,
    out: Path,
    methods: tuple[str, ...] = tuple(RANGES),
    candidates: int = 16,
    seeds: int = 6,
    finalists: int = 3,
    more: int = 10,
) -> None:
    """Tune baselines and print a table; resumes where it stopped.

    Args:
        out: folder of tune.jsonl.
        methods: baselines.
        candidates: parameter sets per baseline, the one by hand among them.
        seeds: worlds for each of them, seeds from 0.
        finalists: sets that go on.
        more: further worlds for those.
    """
    out.mkdir(parents=True, exist_ok=True)
    file = out / "tune.jsonl"
    done = {}
    if file.exists():
        for row in map(json.loads, file.read_text().splitlines()):
            done[row["method"], json.dumps(row["settings"]), row["seed"]] = row

    def rows(method: str, settings: Settings, count: range) -> list[Row]:
        results = []
        for seed in count:
            key = (method, json.dumps(settings), seed)
            if key not in done:
                row = walk(method, seed, settings=(*TUNING, *lines(method, settings)))
                done[key] = {**row, "settings": settings}
                with file.open("a") as stream:
                    stream.write(json.dumps(done[key]) + "\n")
            results.append(done[key])
        return results

    print(TUNING_HEAD, flush=True)
    for method in methods:
        rng = np.random.default_rng(np.random.SeedSequence([ord(c) for c in method]))
        sets = drawn(RANGES[method], candidates, rng)
        table = [(s, rows(method, s, range(seeds))) for s in sets]
        first = table[0][0]
        table.sort(key=lambda pair: mean(pair[1]), reverse=True)
        final = table[:finalists]
        if all(s != first for s, _ in final):
            final.append(next(pair for pair in table if pair[0] == first))
        final = [(s, r + rows(method, s, range(seeds, seeds + more))) for s, r in final]
        final.sort(key=lambda pair: mean(pair[1]), reverse=True)
        before = next(r for s, r in final if s == first)
        best, after = final[0]
        changes = ", ".join(f"`{k}` {first[k]:g} -> {best[k]:g}" for k in best)
        good = [sum(r["success"] for r in rows) for rows in (before, after)]
        print(
            f"| {method} | {mean(before)[0]:.3f} | {mean(after)[0]:.3f} | {good[0]} | {good[1]} | "
            f"{-mean(before)[1]:.0f} | {-mean(after)[1]:.0f} | {changes} |",
            flush=True,
        )


def compare(
    *,
    out: Path,
    scenarios: tuple[str, ...] = ("course", "crowd", "dense", "fast", "conflict", "behind"),
    methods: tuple[str, ...] = ("univector", "paper", *RANGES),
    first: int = 1000,
    runs: int = 50,
) -> None:
    """Compare the planners on held-out seeds and print a table; resumes.

    Args:
        out: folder of compare.jsonl.
        scenarios: their worlds and missions.
        methods: planners; "univector" is the profile extended, "paper" the profile paper.
        first: first seed, 1000 or above.
        runs: worlds of each scenario.
    """
    out.mkdir(parents=True, exist_ok=True)
    file = out / "compare.jsonl"
    done: dict[tuple[str, str, int], Row] = {}
    if file.exists():
        for row in map(json.loads, file.read_text().splitlines()):
            done[row["scenario"], row["method"], row["seed"]] = row
    print(COMPARISON_HEAD, flush=True)
    for scenario in scenarios:
        for seed in range(first, first + runs):
            for method in methods:
                if (scenario, method, seed) in done:
                    continue
                name, settings = method, ()
                if method == "paper":
                    name, settings = "univector", ("navigation.profile=paper",)
                row = walk(name, seed, scenario=scenario, settings=settings)
                row |= {"method": method, "scenario": scenario}
                done[scenario, method, seed] = row
                with file.open("a") as stream:
                    stream.write(json.dumps(row) + "\n")
        for method in methods:
            rows = [done[scenario, method, s] for s in range(first, first + runs)]
            print(summary(scenario, method, rows), flush=True)


def summary(scenario: str, method: str, rows: list[Row]) -> str:
    """Line of the table of a planner in a scenario."""
    n, good = len(rows), sum(r["success"] for r in rows)
    interval = Proportion.counted(good, n)
    times = [r["time"] for r in rows if r["success"]] or [0.0]
    count = {r: sum(row["reason"] == r for row in rows) for r in ("contact", "timeout")}
    return (
        f"| {scenario} | {method} | {good}/{n} | {100 * good / n:.0f} "
        f"[{100 * interval.low:.0f}, {100 * interval.high:.0f}] | "
        f"{count['contact']} | {count['timeout']} | "
        f"{np.median(times):.0f} | "
        f"{100 * float(np.median([r['clearance'] for r in rows])):.1f} | "
        f"{float(np.mean([r['plan_ms'] for r in rows])):.2f} |"
    )


if __name__ == "__main__":
    tyro.extras.subcommand_cli_from_dict({"tune": tune, "compare": compare})
