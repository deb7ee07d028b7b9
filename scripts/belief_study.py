"""Belief study: localization, tracks and map in a 2-D world without MuJoCo.

A robot with slipping odometry tours a field of 12 still and 4 shuttling cylinders in four
colours while its head keeps looking elsewhere. Detections carry the errors of a walking
camera: pitch and yaw errors shared by all of a frame and correlated in time, range noise
of each obstacle's own, occlusion, cuts at the border, misses and false blobs. Identities
are unknown to the estimator.

    python scripts/belief_study.py --first 1000 --runs 30
"""

from dataclasses import dataclass, field
from math import asin, atan2, cos, hypot, pi, sin, sqrt
from time import perf_counter

import numpy as np
import tyro
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief import Belief, Motion, Track
from navigation.belief_parameters import BeliefParameters
from navigation.estimator import Estimator
from navigation.observation import CameraView, Frame, Observation

Array = NDArray[np.float64]

COLOURS = ("red", "green", "blue", "violet")
CAMERA_HEIGHT = 0.47
HFOV, VFOV = 1.50, 1.22
FOCAL = 171.0
RANGE, BEACON_RANGE = 2.5, 5.0
PITCH_SIGMA, YAW_SIGMA = 0.009, 0.006
MATCH = 0.35


@dataclass
class Obstacle:
    """A cylinder, shuttling between two ends if it has a speed."""

    label: str
    start: Array
    end: Array
    speed: float
    radius: float
    phase: float = 0.0

    def state(self, time: float) -> tuple[Array, Array]:
        """Position and velocity at a time."""
        length = float(np.linalg.norm(self.end - self.start))
        if self.speed == 0.0:
            return self.start, np.zeros(2)
        along = (self.phase + self.speed * time) % (2.0 * length)
        way = (self.end - self.start) / length
        if along < length:
            return self.start + along * way, self.speed * way
        return self.end - (along - length) * way, -self.speed * way


class Smooth:
    """First-order Gauss-Markov error."""

    def __init__(self, sigma: float, tau: float, rng: np.random.Generator) -> None:
        self.sigma, self.tau, self.rng = sigma, tau, rng
        self.value = sigma * float(rng.standard_normal())

    def step(self, dt: float) -> float:
        """Advance and return the error."""
        a = float(np.exp(-dt / self.tau))
        self.value = a * self.value + self.sigma * sqrt(1 - a * a) * float(
            self.rng.standard_normal()
        )
        return self.value


def random_world(rng: np.random.Generator, statics: int, movers: int) -> list[Obstacle]:
    """Cylinders with gaps of at least 0.4 m; movers keep clear of the still ones."""
    placed: list[Array] = []
    obstacles = []
    while len(obstacles) < statics:
        p = rng.uniform(-2.2, 2.2, 2)
        if all(np.linalg.norm(p - q) > 0.58 for q in placed):
            placed.append(p)
            label = COLOURS[len(obstacles) % 4]
            obstacles.append(Obstacle(label, p, p, 0.0, float(rng.uniform(0.06, 0.11))))
    while len(obstacles) < statics + movers:
        a, way = rng.uniform(-2.2, 2.2, 2), float(rng.uniform(-pi, pi))
        b = a + rng.uniform(0.8, 1.8) * np.array([cos(way), sin(way)])
        line = a + np.linspace(0, 1, 20)[:, None] * (b - a)
        clear = np.linalg.norm(line[:, None] - np.array(placed), axis=2).min() > 0.40
        if np.abs(b).max() < 2.3 and clear:
            label = COLOURS[int(rng.integers(4))]
            speed, phase = float(rng.uniform(0.06, 0.14)), float(rng.uniform(0, 2))
            obstacles.append(Obstacle(label, a, b, speed, float(rng.uniform(0.06, 0.11)), phase))
    return obstacles


BEACONS = {
    name: (2.9 * cos(a), 2.9 * sin(a))
    for name, a in zip(
        ("yellow/cyan", "cyan/yellow", "yellow/magenta", "magenta/yellow", "cyan/magenta",
         "magenta/cyan"),
        (np.arange(6) * pi / 3 + 0.3).tolist(),
        strict=True,
    )
}  # fmt: skip


class Camera:
    """Noisy detector: what one frame of a walking robot's head camera yields."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        self.pitch = Smooth(0.006, 0.15, rng)
        self.pitch_bias = 0.002 * float(rng.standard_normal())
        self.yaw = Smooth(0.004, 0.15, rng)
        self.sway_phase = float(rng.uniform(0, 2 * pi))
        self.size: dict[int, Smooth] = {}

    def observe(
        self, time: float, pose: Array, pan: float, things: list[tuple[str, str, Array, float]]
    ) -> tuple[Observation, ...]:
        """Observations of `things` (kind, label, position, radius) from a true pose."""
        rng = self.rng
        dt = 0.06
        pitch = self.pitch.step(dt) + self.pitch_bias
        pitch += 0.006 * sin(2 * pi * 1.5 * time + self.sway_phase)
        yaw = self.yaw.step(dt)
        polar = []
        for i, (kind, label, p, radius) in enumerate(things):
            dx, dy = p[0] - pose[0], p[1] - pose[1]
            d = hypot(dx, dy)
            polar.append((i, kind, label, d, wrap(atan2(dy, dx) - pose[2]), radius))
        seen = []
        for i, kind, label, d, b, radius in polar:
            own = self.size.setdefault(i, Smooth(1.0, 0.1, rng)).step(dt)
            half = asin(min(0.9, radius / d))
            off = abs(wrap(b - pan)) - 0.5 * HFOV
            if d > (RANGE if kind == "obstacle" else BEACON_RANGE) or d < 0.2 or off > 0.5 * half:
                continue
            hidden = max(
                (
                    min(1.0, (half + asin(min(0.9, r2 / d2)) - abs(wrap(b - b2))) / (2 * half))
                    for j, k2, _, d2, b2, r2 in polar
                    if j != i and d2 < d and k2 == "obstacle"
                ),
                default=0.0,
            )
            # A beacon is twice as tall and shows above whatever stands before it.
            if (kind == "obstacle" and hidden > 0.7) or rng.random() > 0.97:
                continue
            cut = off > -half
            occluded = hidden > 0.05 and kind == "obstacle"
            worse = (3.0 if cut else 1.0) * (1.5 if occluded else 1.0)
            ground_gain = (CAMERA_HEIGHT**2 + d * d) / CAMERA_HEIGHT
            size_sigma = 0.4 * worse * d * d / (FOCAL * radius) + 0.003
            ground_sigma = ground_gain * PITCH_SIGMA * worse + 0.003
            weight = size_sigma**2 / (size_sigma**2 + ground_sigma**2)
            error = weight * ground_gain * pitch * worse + (1 - weight) * size_sigma * own
            variance = 1.0 / (1.0 / size_sigma**2 + 1.0 / ground_sigma**2)
            bearing_sigma = sqrt(YAW_SIGMA**2 + (0.002 * worse) ** 2)
            bias = 0.5 * (off + half) if cut else 0.0
            bearing = b + yaw + 0.002 * worse * float(rng.standard_normal())
            bearing -= bias * (1.0 if wrap(b - pan) > 0 else -1.0)
            if cut:
                bearing_sigma = hypot(bearing_sigma, half)
            radius_sigma = worse * (0.05 * radius + 0.4 * d / FOCAL)
            seen.append(
                Observation(
                    kind=kind,
                    label=label,
                    distance=max(0.1, d + error),
                    bearing=bearing,
                    covariance=np.diag([variance, bearing_sigma**2]),
                    radius=max(0.02, radius + radius_sigma * own),
                    radius_sigma=radius_sigma,
                    cut=cut,
                    occluded=occluded,
                )
            )
        if rng.random() < 0.005:
            seen.append(
                Observation(
                    "obstacle",
                    COLOURS[int(rng.integers(4))],
                    float(rng.uniform(0.4, RANGE)),
                    pan + float(rng.uniform(-0.7, 0.7)),
                    np.diag([0.01, 1e-4]),
                    0.08,
                    0.03,
                )  # fmt: skip
            )
        return tuple(seen)


def view(pan: float, tilt: float) -> CameraView:
    """Camera at a pan and tilt."""
    cp, sp, ct, st = cos(pan), sin(pan), cos(tilt), sin(tilt)
    forward = np.array([cp * ct, sp * ct, st])
    right = np.array([sp, -cp, 0.0])
    down = np.cross(forward, right)
    rotation = np.stack([right, down, forward], axis=1)
    return CameraView(rotation, np.array([0.0, 0.0, CAMERA_HEIGHT]), pan, tilt, HFOV, VFOV)


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


def run(seed: int, tally: Tally, parameters: BeliefParameters, duration: float) -> None:
    """Simulate one tour and add it to the tally."""
    streams = np.random.SeedSequence(seed).spawn(4)
    rng, noise, legs, own = (np.random.default_rng(s) for s in streams)
    obstacles = random_world(rng, 12, 4)
    pose = np.array([*rng.uniform(-1.5, 1.5, 2), rng.uniform(-pi, pi)])
    start = pose + noise.normal(0, [0.02, 0.02, 0.02])
    estimator = Estimator(parameters, BEACONS, start, np.eye(3) * 4e-4, own)
    camera = Camera(noise)
    odometry = np.zeros(3)
    scale = 1 + 0.03 * float(legs.standard_normal())
    dt, step_end, slip, drift = 0.06, 0.0, np.zeros(3), np.zeros(3)
    target, pan, pan_goal, dwell = pose[:2], 0.0, 0.0, 0.0
    birth: dict[int, tuple[float, float]] = {}
    looked: dict[int, float] = {}
    decided: set[int] = set()
    owners: dict[int, int] = {}
    for k in range(1, int(duration / dt)):
        time = k * dt
        if np.hypot(*(target - pose[:2])) < 0.2:
            target = rng.uniform(-1.8, 1.8, 2)
        error = wrap(atan2(*(target - pose[:2])[::-1].tolist()) - float(pose[2]))
        body = np.array([0.18 * max(0.0, cos(error)), 0.0, max(-0.8, min(0.8, 1.5 * error))])
        if time >= step_end:
            step_end += 0.34
            slip = legs.normal(0, [0.06, 0.06, 0.04])
            drift = legs.normal(0, [0.005, 0.005, 0.02])
        for true_body, which in (
            (body * (1 + slip) * [scale, 1, 1] + drift, pose),
            (body, odometry),
        ):
            heading = which[2] + 0.5 * true_body[2] * dt
            which[0] += dt * (cos(heading) * true_body[0] - sin(heading) * true_body[1])
            which[1] += dt * (sin(heading) * true_body[0] + cos(heading) * true_body[1])
            which[2] += dt * true_body[2]
        if time >= dwell:
            pan_goal = float(rng.uniform(-1.5, 1.5))
            dwell = time + abs(pan_goal - pan) / 6.0 + float(rng.uniform(0.2, 0.9))
        pan += max(-6 * dt, min(6 * dt, pan_goal - pan))
        things = [("obstacle", o.label, o.state(time)[0], o.radius) for o in obstacles]
        things += [("beacon", n, np.array(p), 0.05) for n, p in BEACONS.items()]
        seen = camera.observe(time, pose, pan, things)
        frame = Frame(time, odometry.copy(), True, view(pan, -0.44), seen)
        began = perf_counter()
        belief = estimator.update(frame)
        tally.milliseconds.append(1e3 * (perf_counter() - began))
        tally.frames += 1
        tally.add_pose(belief, pose)
        matched = tally.add_tracks(belief.tracks, obstacles, time)
        tally.seen_share.append(len(set(matched.values())) / len(obstacles))
        for t in belief.tracks:
            if t.id in matched:
                if t.particles is None:
                    tally.swaps += owners.get(t.id, matched[t.id]) != matched[t.id]
                    owners[t.id] = matched[t.id]
            birth.setdefault(t.id, (time, 0.0))
            looked[t.id] = looked.get(t.id, 0.0) + dt * t.visible
            if t.motion is not Motion.UNKNOWN and t.id not in decided and t.id in matched:
                decided.add(t.id)
                mover = obstacles[matched[t.id]].speed > 0
                if mover and t.motion is Motion.MOVING:
                    tally.time_to_move.append(looked[t.id])
                if not mover and t.motion is Motion.STATIC:
                    tally.time_to_static.append(looked[t.id])
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
