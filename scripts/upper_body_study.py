"""What swinging arms and a moving head do to the trunk, the feet and the centre of pressure.

    python scripts/upper_body_study.py --seeds 0 1 --duration 15

Sensor noise and leg collisions on. Tune on seeds 0-99, report on seeds from 1000.
"""

import argparse
from dataclasses import replace

from walking.body.robot_model import RobotModel
from walking.command import HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD, ArmParameters, WalkingParameters

import numpy as np
from speed_study import SETTLED, zmp_error
from study_page import add_seeds
from walking_body import ROBOT, Body, Plant
from walking_trial import random_script, steady_script

WALKS = {"0.2 m/s": (0.2, 0.0, 0.0), "0.4 m/s": (0.4, 0.0, 0.0), "0.1 m/s left": (0.0, 0.1, 0.0)}
COLUMNS = (
    "| walk | arms | head | yaw rate of the trunk, rms | its drift, no heading hold "
    "| support foot turns by | CoP - planned ZMP, rms | tilt p99 |\n" + 8 * "|---" + "|"
)


def measured(
    robot: RobotModel,
    velocity: tuple[float, float, float],
    seed: int,
    duration: float,
    **made: bool,
) -> list[np.ndarray]:
    """Yaw rate and tilt; heading; turns of the support foot; CoP error [rad/s, °, rad, m]."""
    usual = WalkingParameters()
    parameters = replace(
        usual,
        arms=usual.arms if made["arms"] else ArmParameters(swing_gain=0.0),
        stabilizer=replace(usual.stabilizer, heading_gain=0.0),
    )
    body = Body(np.random.default_rng([seed, 3]), Plant())
    engine = WalkingEngine(robot, parameters)
    script, saccades = steady_script(VelocityCommand(*velocity)), random_script(seed)
    sites = [int(body.model.site(f"{side}_foot").id) for side in "lr"]
    trunk, heading, turns, pressure = [], [], [], []
    support: tuple[str, float] | None = None
    for tick in range(round(duration / CONTROL_PERIOD)):
        now = tick * CONTROL_PERIOD
        head = saccades(now)[1] if made["head"] else HeadTarget()
        targets = engine.step(body.sense(), script(now)[0], head)
        body.apply(targets.setpoint)
        if now < SETTLED:
            continue
        state = engine.state()
        phase = str(state.phase)
        trunk.append((body.data.qvel[5], np.degrees(np.arccos(min(1.0, body.up)))))
        heading.append(body.pose[2])
        if phase in ("left", "right"):
            R = body.data.site_xmat[sites[phase == "right"]].reshape(3, 3)
            yaw = float(np.arctan2(R[1, 0], R[0, 0]))
            if support is None or support[0] != phase:
                support = phase, yaw
            last = yaw - support[1]
        elif support is not None:
            turns.append(last)
            support = None
        found = zmp_error(body, engine, (sites[0], sites[1]))
        pressure += [] if found is None else [found]
    return [np.array(rows) for rows in (trunk, np.unwrap(heading), turns, pressure)]


def row(robot: RobotModel, name: str, seeds: list[int], duration: float, **made: bool) -> str:
    """One line of the table."""
    walks = [measured(robot, name, seed, duration, **made) for seed in seeds]
    rate, tilt = np.concatenate([walk[0] for walk in walks]).T
    drift = np.mean([np.degrees(h[-1] - h[0]) / (duration - SETTLED) for _, h, _, _ in walks])
    turns = np.degrees(np.abs(np.concatenate([walk[2] for walk in walks]))).mean()
    zmp = 1e3 * np.sqrt((np.concatenate([walk[3] for walk in walks]) ** 2).mean(axis=0))
    return (
        f"| {name} | {'swing' if made['arms'] else 'still'} "
        f"| {'saccades' if made['head'] else 'still'} | {np.sqrt((rate**2).mean()):.3f} rad/s "
        f"| {drift:+.2f} °/s | {turns:.2f}° | {zmp[0]:.1f} / {zmp[1]:.1f} mm "
        f"| {np.percentile(tilt, 99):.2f}° |"
    )


def main() -> None:
    """Run the study."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_seeds(parser)
    parser.add_argument("--duration", type=float, default=15.0)
    options = parser.parse_args()
    robot = RobotModel.from_mjcf(ROBOT)
    print(COLUMNS)
    for name in WALKS:
        for arms, head in ((True, False), (False, False), (True, True)):
            line = row(robot, name, options.seeds, options.duration, arms=arms, head=head)
            print(line, flush=True)


if __name__ == "__main__":
    main()
