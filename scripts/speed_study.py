"""How fast, how true to the command and how close to its plan the engine walks in full physics.

    python scripts/speed_study.py straight --seeds 1000 1001 --duration 60
    python scripts/speed_study.py box --seeds 1000
    python scripts/speed_study.py stop --seeds 1000-1049
    python scripts/speed_study.py odometry --seeds 1000 1001

Sensor noise and leg collisions on. Tune on seeds 0-99, report on seeds from 1000.
"""

import argparse
from dataclasses import dataclass, field
from itertools import pairwise, product

from hsr8.robots.loaded import load_robot
from walking.body.joints import LEFT_LEG, LEG_JOINTS, RIGHT_LEG
from walking.command import HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.odometry import Odometry, increment
from walking.parameters import CONTROL_PERIOD, WalkingParameters

import mujoco
import numpy as np
from study_page import add_seeds
from walking_body import Body, Plant
from walking_trial import Script, parameters_of, random_script, steady_script

SETTLED = 3.0  # time after which a walk is measured [s]
FAST = {
    "forward": (0.45, 0.0, 0.0),
    "forward, stretch": (0.55, 0.0, 0.0),
    "back": (-0.40, 0.0, 0.0),
    "back, stretch": (-0.45, 0.0, 0.0),
    "side": (0.0, 0.16, 0.0),
    "side, stretch": (0.0, 0.20, 0.0),
    "turn": (0.0, 0.0, 1.5),
    "turn, stretch": (0.0, 0.0, 2.0),
}
WALKS = {
    "forward 0.2": (0.2, 0.0, 0.0),
    "forward 0.4": (0.4, 0.0, 0.0),
    "back 0.2": (-0.2, 0.0, 0.0),
    "side 0.1": (0.0, 0.1, 0.0),
    "turn 1.0": (0.0, 0.0, 1.0),
}
STOPS = (*FAST.values(), (0.45, 0.1, 0.6), (0.3, -0.15, -1.0))
HORIZONS = (1, 2, 5, 10, 20, 50)


@dataclass
class Walk:
    """What a walk left behind; the lists have one entry per tick, or per footstep."""

    fallen: bool = False
    standing: bool = False
    poses: list[np.ndarray] = field(default_factory=list)
    tilt: list[float] = field(default_factory=list)
    steps: list[int] = field(default_factory=list)
    zmp_error: list[np.ndarray] = field(default_factory=list)
    landed: list[tuple[np.ndarray, Odometry]] = field(default_factory=list)
    torque: np.ndarray = field(default_factory=lambda: np.zeros(26))
    speed: np.ndarray = field(default_factory=lambda: np.zeros(26))
    at_limit: int = 0

    def velocity(self) -> np.ndarray:
        """Mean velocity (vx, vy, wz) once settled, pairs of footsteps [m/s, m/s, rad/s] (3,).

        In a part of a pair the body sways and turns as it does not on the whole.
        """
        first = round(SETTLED / CONTROL_PERIOD)
        landed = first + np.flatnonzero(np.diff(self.steps[first:]))
        pairs = (len(landed) - 1) // 2
        rows = np.array(self.poses)[landed[0] : landed[2 * pairs] + 1]
        rows[:, 2] = np.unwrap(rows[:, 2])
        d = np.diff(rows, axis=0)
        middle = 0.5 * (rows[1:, 2] + rows[:-1, 2])
        c, s = np.cos(middle), np.sin(middle)
        moved = np.array([(c * d[:, 0] + s * d[:, 1]).mean(), (c * d[:, 1] - s * d[:, 0]).mean()])
        return np.array([*moved, d[:, 2].mean()]) / CONTROL_PERIOD


def pressure(body: Body) -> np.ndarray | None:
    """Centre of pressure of the floor on the robot (2,) [m]."""
    load, moment, force = 0.0, np.zeros(2), np.zeros(6)
    for i in range(body.data.ncon):
        contact = body.data.contact[i]
        if 0 in body.model.geom_bodyid[contact.geom]:
            mujoco.mj_contactForce(body.model, body.data, i, force)
            load += force[0]
            moment += force[0] * contact.pos[:2]
    return moment / load if load > 1.0 else None


def zmp_error(body: Body, engine: WalkingEngine, sites: tuple[int, int]) -> np.ndarray | None:
    """True centre of pressure less planned ZMP, both seen from the support foot (2,) [m]."""
    state, measured = engine.state(), pressure(body)
    if measured is None or state.phase == "standing":
        return None
    support = state.footsteps[0]
    site = sites[0 if support.left else 1]
    R = body.data.site_xmat[site].reshape(3, 3)
    true = _turned(measured - body.data.site_xpos[site, :2], np.arctan2(R[1, 0], R[0, 0]))
    return true - _turned(state.zmp - [support.x, support.y], support.yaw)


def _turned(vector: np.ndarray, yaw: float) -> np.ndarray:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([c * vector[0] + s * vector[1], c * vector[1] - s * vector[0]])


class Study:
    """Walks one robot with one set of parameters."""

    def __init__(self, parameters: WalkingParameters, friction: float) -> None:
        self._robot = load_robot("hsr8").model
        self._parameters = parameters
        self._plant = Plant(friction=friction)

    def walk(self, script: Script, seed: int, duration: float, *, zmp: bool = False) -> Walk:
        """Walk a script until it ends or the robot falls."""
        body = Body(np.random.default_rng([seed, 3]), self._plant)
        engine, walk = WalkingEngine(self._robot, self._parameters), Walk()
        low, high = body.model.actuator_ctrlrange.T
        dof = body.model.jnt_dofadr[body.model.actuator_trnid[:, 0]]
        names = (f"{side}_foot" for side in "lr")
        left, right = (int(body.model.site(name).id) for name in names)
        steps = 0
        for tick in range(round(duration / CONTROL_PERIOD)):
            now = tick * CONTROL_PERIOD
            targets = engine.step(body.sense(), *script(now))
            state = engine.state()
            if state.step_count != steps:
                steps = state.step_count
                walk.landed.append((body.pose, state.odometry))
            control = targets.setpoint
            walk.at_limit += bool(((control <= low) | (control >= high))[: RIGHT_LEG.stop].any())
            body.apply(control)
            walk.poses.append(body.pose)
            walk.tilt.append(float(np.degrees(np.arccos(min(1.0, body.up)))))
            walk.steps.append(steps)
            walk.torque = np.maximum(walk.torque, np.abs(body.data.actuator_force))
            walk.speed = np.maximum(walk.speed, np.abs(body.data.qvel[dof]))
            if zmp and now > SETTLED:
                error = zmp_error(body, engine, (left, right))
                walk.zmp_error += [] if error is None else [error]
            if body.fallen:
                walk.fallen = True
                break
        walk.standing = engine.state().phase == "standing"
        return walk

    def straight(self, seeds: list[int], duration: float, names: list[str]) -> None:
        """Fast walks in one direction."""
        for name, velocity in ((name, FAST[name]) for name in names):
            script = steady_script(VelocityCommand(*velocity))
            walks = [self.walk(script, seed, duration) for seed in seeds]
            speed = np.mean([walk.velocity() for walk in walks if not walk.fallen], axis=0)
            tilt = np.concatenate([walk.tilt for walk in walks])
            torque = np.max([walk.torque for walk in walks], axis=0)
            rate = np.max([walk.speed for walk in walks], axis=0)
            print(
                f"{name:17} {velocity}: {sum(w.fallen for w in walks)} falls of {len(walks)}, "
                f"walked {speed.round(3).tolist()}, tilt p99 {np.percentile(tilt, 99):.1f} deg; "
                f"leg setpoints at the end of the range in {sum(w.at_limit for w in walks)} ticks\n"
                f"    largest torque {_legs(torque)} N m, speed {_legs(rate)} rad/s",
                flush=True,
            )

    def box(self, seeds: list[int], duration: float) -> None:
        """Error of the speed over a grid of commands, and of the ZMP at 0.2 m/s."""
        grid = list(product((-0.3, -0.15, 0.15, 0.3, 0.45), (-0.1, 0.0, 0.1), (-0.8, 0.0, 0.8)))
        errors = []
        for velocity, seed in product(grid, seeds):
            walk = self.walk(steady_script(VelocityCommand(*velocity)), seed, duration)
            errors.append((*velocity, *(walk.velocity() - velocity)))
        table = np.array(errors)
        for axis, name in enumerate(("forward", "left", "turn")):
            asked, error = table[:, axis], table[:, 3 + axis]
            on = asked != 0.0
            share = np.abs(error[on] / asked[on])
            print(f"{name:8} mean error {share.mean():.1%}, largest {share.max():.1%}", flush=True)
        script = steady_script(VelocityCommand(0.2))
        errors = np.concatenate([self.walk(script, s, duration, zmp=True).zmp_error for s in seeds])
        rms = 1e3 * np.sqrt((errors**2).mean(axis=0))
        print(f"CoP - planned ZMP at 0.2 m/s: rms {rms.round(1).tolist()}, {np.hypot(*rms):.1f} mm")

    def stop(self, seeds: list[int]) -> None:
        """Stops from full speed in any phase: falls, and footsteps begun after the command."""
        walks: list[Walk] = []
        begun: list[int] = []
        tilt: list[float] = []
        for k, velocity in enumerate(STOPS):
            moving = VelocityCommand(*velocity)
            for seed in seeds:
                at = SETTLED + np.random.default_rng([seed, 13, k]).uniform(0.0, 0.7)

                def script(
                    now: float, moving: VelocityCommand = moving, at: float = at
                ) -> tuple[VelocityCommand, HeadTarget]:
                    return (moving if now < at else VelocityCommand()), HeadTarget()

                walk = self.walk(script, seed, at + 2.0)
                tick = round(at / CONTROL_PERIOD)
                # The footstep under way when the command comes is not one that begins after it.
                begun.append(max(0, walk.steps[-1] - walk.steps[tick] - 1))
                tilt += walk.tilt[tick:]
                walks.append(walk)
            counts = np.bincount(begun[-len(seeds) :], minlength=3).tolist()
            print(f"{velocity!s:20} footsteps begun {counts}", flush=True)
        print(
            f"{len(walks)} stops: {sum(w.fallen for w in walks)} falls, "
            f"{sum(not w.standing for w in walks)} still stepping; footsteps begun "
            f"{np.bincount(begun, minlength=3).tolist()}; tilt from the command on, p99 "
            f"{np.percentile(tilt, 99):.1f} deg, largest {max(tilt):.1f} deg"
        )

    def odometry(self, seeds: list[int], duration: float) -> None:
        """Error with ideal heading; NEES of increments over footsteps."""
        scripts = {name: steady_script(VelocityCommand(*v)) for name, v in WALKS.items()}
        for name in (*scripts, "random"):
            walks = [
                self.walk(scripts.get(name) or random_script(s), s, duration).landed[3:]
                for s in seeds
            ]
            nees = [np.mean(np.concatenate([_nees(w, n) for w in walks])) for n in HORIZONS]
            drift = np.mean([_drift(walk) for walk in walks])
            shown = ", ".join(f"{n}: {v:.2f}" for n, v in zip(HORIZONS, nees, strict=True))
            print(f"{name:12} {drift:.2%} of the path; NEES per freedom {shown}", flush=True)


def _legs(values: np.ndarray) -> str:
    both = np.maximum(values[LEFT_LEG], values[RIGHT_LEG])
    return ", ".join(f"{name} {v:.1f}" for name, v in zip(LEG_JOINTS, both, strict=True))


def _moved(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    turn = (after[2] - before[2] + np.pi) % (2.0 * np.pi) - np.pi
    return np.array([*_turned((after - before)[:2], before[2]), turn])


def _nees(walk: list[tuple[np.ndarray, Odometry]], horizon: int) -> list[float]:
    values = []
    for (pose, start), (other, end) in zip(walk[:-horizon], walk[horizon:], strict=True):
        moved = increment(start, end)
        error = moved.motion - _moved(pose, other)
        error[2] = (error[2] + np.pi) % (2.0 * np.pi) - np.pi
        values.append(float(error @ np.linalg.solve(moved.covariance, error)) / 3.0)
    return values


def _drift(walk: list[tuple[np.ndarray, Odometry]]) -> float:
    """Return the final position error per path length, with the true headings of footsteps [1]."""
    error, length = np.zeros(2), 0.0
    for (pose, start), (other, end) in pairwise(walk):
        moved = _turned(increment(start, end).motion[:2], -pose[2])
        error += moved - (other - pose)[:2]
        length += float(np.hypot(*(other - pose)[:2]))
    return float(np.hypot(*error)) / length


def main() -> None:
    """Run one of the studies."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", choices=("straight", "box", "stop", "odometry"))
    add_seeds(parser)
    parser.add_argument("--duration", type=float, default=30.0)
    parser.add_argument("--only", nargs="+", choices=FAST, default=list(FAST), help="fast walks")
    parser.add_argument("--friction", type=float, default=0.8)
    parser.add_argument("--set", nargs="*", default=[], help="parameters, group.name=value")
    options = parser.parse_args()
    study = Study(parameters_of(options.set), options.friction)
    if options.study == "stop":
        study.stop(options.seeds)
    elif options.study == "straight":
        study.straight(options.seeds, options.duration, options.only)
    else:
        getattr(study, options.study)(options.seeds, options.duration)


if __name__ == "__main__":
    main()
