"""Belief study: localization, tracks and map in a 2-D world without MuJoCo.

A robot with slipping odometry tours a field of 12 still and 4 shuttling cylinders in four
colours while its head keeps looking elsewhere. Detections carry the errors of a walking
camera: pitch and yaw errors shared by all of a frame and correlated in time, range noise
of each obstacle's own, occlusion, cuts at the border, misses and false blobs. Identities
are unknown to the estimator.

    python scripts/belief_study.py --first 1000 --runs 30
"""

from dataclasses import dataclass, field
from math import hypot
from time import process_time

import numpy as np
import tyro
from belief_world import (
    BEACONS,
    FRAME,
    TILT,
    Array,
    Camera,
    Obstacle,
    Thing,
    Walker,
    random_world,
    view,
)

from navigation.angles import wrap
from navigation.belief import Belief, Motion, Track
from navigation.belief_parameters import BeliefParameters
from navigation.estimator import Estimator
from navigation.observation import Frame

MATCH = 0.35
"""Distance up to which a track belongs to an obstacle [m]."""


@dataclass
class Tally:
    """Sums over all frames of all runs."""

    position: list[float] = field(default_factory=list)
    heading: list[float] = field(default_factory=list)
    nees: list[float] = field(default_factory=list)
    lost: int = 0
    faults: int = 0
    frames: int = 0
    milliseconds: list[float] = field(default_factory=list)
    mover: dict[str, int] = field(default_factory=dict)
    static: dict[str, int] = field(default_factory=dict)
    mover_visible: dict[str, int] = field(default_factory=dict)
    static_visible: dict[str, int] = field(default_factory=dict)
    static_error: list[float] = field(default_factory=list)
    mover_error: list[float] = field(default_factory=list)
    velocity_error: list[float] = field(default_factory=list)
    track_nees: list[float] = field(default_factory=list)
    static_nees: list[float] = field(default_factory=list)
    ghosts: int = 0
    duplicates: int = 0
    clouds: int = 0
    stray_clouds: int = 0
    swaps: int = 0
    time_to_move: list[float] = field(default_factory=list)
    time_to_static: list[float] = field(default_factory=list)
    seen_share: list[float] = field(default_factory=list)
    cloud_distance: list[float] = field(default_factory=list)

    def add_pose(self, belief: Belief, pose: Array) -> None:
        """Compare a belief with the true pose."""
        e = belief.pose - pose
        e[2] = wrap(float(e[2]))
        self.position.append(hypot(e[0], e[1]))
        self.heading.append(abs(float(e[2])))
        self.nees.append(float(e @ np.linalg.solve(belief.pose_covariance, e)) / 3.0)
        self.lost += belief.lost

    def add_tracks(
        self, tracks: tuple[Track, ...], obstacles: list[Obstacle], time: float
    ) -> dict[int, int]:
        """Match tracks to the truth; return obstacle index by track id."""
        owner: dict[int, int] = {}
        truth = [o.state(time) for o in obstacles]
        firm = [t for t in tracks if t.particles is None]
        pairs = sorted(
            (float(np.hypot(*(t.position - truth[i][0]))), k, i)
            for k, t in enumerate(firm)
            for i, o in enumerate(obstacles)
            if o.label == t.label
        )
        taken: set[int] = set()
        matched: dict[int, int] = {}
        for distance, k, i in pairs:
            if distance > MATCH:
                break
            if k not in matched and i not in taken:
                matched[k] = i
                taken.add(i)
        for k, t in enumerate(firm):
            if k not in matched:
                near = any(
                    o.label == t.label and np.hypot(*(truth[i][0] - t.position)) < MATCH
                    for i, o in enumerate(obstacles)
                )
                self.duplicates += near
                self.ghosts += not near
                continue
            owner[t.id] = matched[k]
            self._add(t, obstacles[matched[k]], truth[matched[k]])
        for t in tracks:
            if t.particles is None:
                continue
            self.clouds += 1
            free = [
                (float(np.min(np.hypot(*(t.particles.positions - truth[i][0]).T))), i)
                for i, o in enumerate(obstacles)
                if o.label == t.label and i not in taken
            ]
            if not free or min(free)[0] > 0.5:
                self.stray_clouds += 1
            else:
                distance, i = min(free)
                taken.add(i)
                owner[t.id] = i
                counts = self.mover if obstacles[i].speed else self.static
                counts[t.motion] = counts.get(t.motion, 0) + 1
                self.cloud_distance.append(distance)
        return owner

    def _add(self, t: Track, obstacle: Obstacle, truth: tuple[Array, Array]) -> None:
        moving = obstacle.speed > 0
        for counts, wanted in (
            (self.mover if moving else self.static, True),
            (self.mover_visible if moving else self.static_visible, t.visible),
        ):
            if wanted:
                counts[t.motion] = counts.get(t.motion, 0) + 1
        error = t.position - truth[0]
        if moving and t.visible and t.hits > 10:
            self.mover_error.append(float(np.hypot(*error)))
            both = np.concatenate([error, t.velocity - truth[1]])
            if t.motion is Motion.MOVING:
                self.velocity_error.append(float(np.hypot(*both[2:])))
            self.track_nees.append(float(both @ np.linalg.solve(t.covariance, both)) / 4.0)
        elif not moving and t.motion is Motion.STATIC:
            self.static_error.append(float(np.hypot(*error)))
            self.static_nees.append(
                float(error @ np.linalg.solve(t.covariance[:2, :2], error)) / 2.0
            )


class Verdicts:
    """Who each track is, and how long it was looked at before it was judged."""

    def __init__(self) -> None:
        self.owners: dict[int, int] = {}
        self.looked: dict[int, float] = {}
        self.judged: set[int] = set()

    def add(
        self, belief: Belief, matched: dict[int, int], obstacles: list[Obstacle], tally: Tally
    ) -> None:
        """Take in the matches of one frame."""
        for t in belief.tracks:
            self.looked[t.id] = self.looked.get(t.id, 0.0) + FRAME * t.visible
            owner = matched.get(t.id)
            if owner is None:
                continue
            if t.particles is None:
                tally.swaps += self.owners.get(t.id, owner) != owner
                self.owners[t.id] = owner
            if t.motion is Motion.UNKNOWN or t.id in self.judged:
                continue
            self.judged.add(t.id)
            moves = obstacles[owner].speed > 0
            if moves and t.motion is Motion.MOVING:
                tally.time_to_move.append(self.looked[t.id])
            if not moves and t.motion is Motion.STATIC:
                tally.time_to_static.append(self.looked[t.id])


def run(seed: int, tally: Tally, parameters: BeliefParameters, duration: float) -> None:
    """Simulate one tour and add it to the tally."""
    streams = np.random.SeedSequence(seed).spawn(4)
    rng, noise, legs, own = (np.random.default_rng(s) for s in streams)
    obstacles = random_world(rng, 12, 4)
    walker = Walker(rng, legs)
    start = walker.pose + noise.normal(0, [0.02, 0.02, 0.02])
    estimator = Estimator(parameters, BEACONS, start, np.eye(3) * 4e-4, own)
    camera = Camera(noise)
    verdicts = Verdicts()
    posts: list[Thing] = [("beacon", n, np.array(p), 0.05) for n, p in BEACONS.items()]
    for k in range(1, int(duration / FRAME)):
        time = k * FRAME
        walker.step(time, FRAME)
        things: list[Thing] = [("obstacle", o.label, o.state(time)[0], o.radius) for o in obstacles]
        seen = camera.observe(time, walker.pose, walker.pan, things + posts)
        frame = Frame(time, walker.odometry.copy(), True, view(walker.pan, TILT), seen)
        began = process_time()
        belief = estimator.update(frame)
        tally.milliseconds.append(1e3 * (process_time() - began))
        tally.frames += 1
        tally.add_pose(belief, walker.pose)
        matched = tally.add_tracks(belief.tracks, obstacles, time)
        tally.seen_share.append(len(set(matched.values())) / len(obstacles))
        verdicts.add(belief, matched, obstacles, tally)
    tally.faults += belief.filter_faults


def rms(values: list[float]) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values)))) if values else float("nan")


def report(tally: Tally) -> None:
    """Print the table."""
    n = tally.frames

    def shares(counts: dict[str, int]) -> str:
        total = max(1, sum(counts.values()))
        return ", ".join(f"{m.value} {100 * counts.get(m, 0) / total:.1f} %" for m in Motion)

    def quantiles(values: list[float]) -> str:
        return f"{np.median(values):.2f} / {np.percentile(values, 90):.2f}" if values else "-"

    rows = [
        ("position rmse / p95 [cm]", f"{100 * rms(tally.position):.2f} / "
         f"{100 * np.percentile(tally.position, 95):.2f}"),
        ("heading rmse [deg]", f"{np.degrees(rms(tally.heading)):.2f}"),
        ("pose NEES/3", f"{np.mean(tally.nees):.2f}"),
        ("lost frames, filter faults", f"{tally.lost}, {tally.faults}"),
        ("movers", shares(tally.mover)),
        ("movers, visible", shares(tally.mover_visible)),
        ("statics", shares(tally.static)),
        ("statics, visible", shares(tally.static_visible)),
        ("time in view to moving, median / p90 [s]", quantiles(tally.time_to_move)),
        ("time in view to static, median / p90 [s]", quantiles(tally.time_to_static)),
        ("static position rmse [cm], NEES/2", f"{100 * rms(tally.static_error):.1f}, "
         f"{np.mean(tally.static_nees):.2f}"),
        ("visible mover position rmse [cm], NEES/4", f"{100 * rms(tally.mover_error):.1f}, "
         f"{np.mean(tally.track_nees):.2f}"),
        (
            "visible mover velocity error rms, median [cm/s]",
            f"{100 * rms(tally.velocity_error):.1f}, {100 * np.median(tally.velocity_error):.1f}",
        ),
        ("known share of obstacles", f"{100 * np.mean(tally.seen_share):.1f} %"),
        ("ghosts, duplicates per frame", f"{tally.ghosts / n:.4f}, {tally.duplicates / n:.4f}"),
        ("clouds, stray clouds per frame", f"{tally.clouds / n:.2f}, {tally.stray_clouds / n:.2f}"),
        ("nearest particle to its mover, rms [cm]", f"{100 * rms(tally.cloud_distance):.1f}"),
        ("identity swaps per 1000 frames", f"{1000 * tally.swaps / n:.2f}"),
        ("time per frame mean / p95 [ms]", f"{np.mean(tally.milliseconds):.2f} / "
         f"{np.percentile(tally.milliseconds, 95):.2f}"),
    ]  # fmt: skip
    for name, value in rows:
        print(f"{name:45s} {value}")


def main(first: int = 0, runs: int = 10, duration: float = 60.0) -> None:
    """Run the study and print its table.

    Args:
        first: first seed; 0-99 are for tuning, 1000 and above for reports.
        runs: number of seeds.
        duration: simulated time of each run [s].
    """
    tally = Tally()
    for seed in range(first, first + runs):
        run(seed, tally, BeliefParameters(), duration)
    print(f"{runs} runs of {duration:g} s, seeds {first}-{first + runs - 1}")
    report(tally)


if __name__ == "__main__":
    tyro.cli(main)
