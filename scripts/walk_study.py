"""Walk the engine in full physics under sensor noise and report how well it does.

    python scripts/walk_study.py random --seeds 1000 1001 --duration 120
    python scripts/walk_study.py steady --vx 0.25 --duration 60
    python scripts/walk_study.py profile

Tune on seeds 0-99, report on seeds from 1000.
"""

import argparse
import cProfile
import pstats

from hsr8.robots.loaded import load_robot
from walking.command import HeadTarget, VelocityCommand
from walking.engine import WalkingEngine

import numpy as np
from study_page import add_seeds
from walking_body import Body, Plant
from walking_trial import SAMPLE_TIME, Trace, parameters_of, random_script, steady_script, walk


def in_heading(rows: np.ndarray) -> np.ndarray:
    """Displacements between poses (n, 3), in the heading of the earlier one (n - 1, 3)."""
    d, yaw = np.diff(rows, axis=0), rows[:-1, 2]
    c, s = np.cos(yaw), np.sin(yaw)
    return np.stack([c * d[:, 0] + s * d[:, 1], c * d[:, 1] - s * d[:, 0], d[:, 2]], axis=1)


def upright(trace: Trace) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Truth, odometry (n, 3) and step counts (n,) until the first fall."""
    end = round(trace.falls[0] / SAMPLE_TIME) if trace.falls else len(trace.steps)
    truth, odometry = np.array(trace.truth[:end]), np.array(trace.odometry[:end])
    truth[:, 2] = np.unwrap(truth[:, 2])
    return truth, odometry, np.array(trace.steps[:end])


def report(name: str, trace: Trace) -> None:
    """A few lines."""
    tilt = np.array(trace.tilt)
    truth, odometry, steps = upright(trace)
    window = round(5.0 / SAMPLE_TIME)
    moved, believed = in_heading(truth[::window]), in_heading(odometry[::window])
    errors = np.linalg.norm((believed - moved)[:, :2], axis=1)
    stride = np.flatnonzero(np.diff(steps)) + 1
    path = np.linalg.norm(np.diff(truth[stride, :2], axis=0), axis=1).sum()
    scale = np.linalg.norm(believed[:, :2], axis=1).sum() / max(
        1e-9, np.linalg.norm(moved[:, :2], axis=1).sum()
    )
    yaw = truth[:, 2] - odometry[:, 2]
    print(
        f"{name}: falls {len(trace.falls)} {[round(t, 1) for t in trace.falls][:4]}, "
        f"{steps[-1]} steps, tilt p50/p99/p99.9/max "
        f"{np.percentile(tilt, 50):.2f} {np.percentile(tilt, 99):.2f} "
        f"{np.percentile(tilt, 99.9):.2f} {tilt.max():.1f} deg, "
        f"self contact {trace.self_contacts} of {len(tilt)} samples"
    )
    if len(stride) > 2:
        step_error = in_heading(odometry[stride]) - in_heading(truth[stride])
        print(
            f"    odometry {100.0 * errors.sum() / path:.1f} cm/m over 5 s windows, "
            f"scale {scale:.3f}, yaw {np.degrees(yaw[-1] - yaw[0]):+.2f} deg; a footstep's error "
            f"mean {(1e3 * step_error.mean(axis=0)).round(2).tolist()} "
            f"std {(1e3 * step_error.std(axis=0)).round(2).tolist()} mm, mm, mrad"
        )
    across, elevation, height = (1e3 * np.array(trace.camera_error).std(axis=0)).tolist()
    print(
        f"    camera std: bearing {across:.1f} mrad, elevation {elevation:.1f} mrad, "
        f"height {height:.2f} mm; engine {1e6 * trace.cpu_engine / trace.ticks:.0f} us, "
        f"physics {1e6 * trace.cpu_physics / trace.ticks:.0f} us a tick",
        flush=True,
    )


def mean_velocity(trace: Trace, settle: float = 3.0, stride: int = 34) -> np.ndarray:
    """Mean velocity (vx, vy, wz) after `settle` [m/s, m/s, rad/s] (3,).

    Every `stride` samples, two footsteps, so that the sway cancels.
    """
    truth, _, _ = upright(trace)
    rows = truth[round(settle / SAMPLE_TIME) :: stride]
    if len(rows) < 2:
        return np.full(3, np.nan)
    return in_heading(rows).mean(axis=0) / (stride * SAMPLE_TIME)


def main() -> None:
    """Run one of the studies."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", choices=("random", "steady", "profile"))
    add_seeds(parser)
    parser.add_argument("--duration", type=float, default=60.0)
    parser.add_argument("--vx", type=float, default=0.0)
    parser.add_argument("--vy", type=float, default=0.0)
    parser.add_argument("--wz", type=float, default=0.0)
    parser.add_argument("--noise", type=float, default=1.0, help="multiple of the sensor noise")
    parser.add_argument("--friction", type=float, default=0.8)
    parser.add_argument("--set", nargs="*", default=[], help="parameters, group.name=value")
    options = parser.parse_args()
    robot = load_robot("hsr8").model
    parameters = parameters_of(options.set)
    plant = Plant(noise=options.noise, friction=options.friction)
    command = VelocityCommand(options.vx, options.vy, options.wz)

    def engine() -> WalkingEngine:
        return WalkingEngine(robot, parameters)

    if options.study == "profile":
        body, walker = Body(np.random.default_rng(0), plant), engine()
        frames = []
        for _ in range(2000):
            sensors = body.sense()
            frames.append(sensors)
            targets = walker.step(sensors, command, HeadTarget())
            body.apply(targets.setpoint)
        walker = engine()
        with cProfile.Profile() as profile:
            for sensors in frames:
                walker.step(sensors, command, HeadTarget())
        pstats.Stats(profile).sort_stats("tottime").print_stats(25)
        return
    for seed in options.seeds:
        rng = np.random.default_rng([seed, 3])

        def body(rng: np.random.Generator = rng) -> Body:
            return Body(rng, plant)

        if options.study == "random":
            report(f"random {seed}", walk(engine, body, random_script(seed), options.duration))
        else:
            trace = walk(engine, body, steady_script(command), options.duration)
            report(f"steady {seed} {mean_velocity(trace).round(3).tolist()}", trace)


if __name__ == "__main__":
    main()
