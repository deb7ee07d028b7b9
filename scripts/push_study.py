"""Push the torso in full physics under sensor noise and count who stays on its feet.

    python scripts/push_study.py walking --seeds 1000
    python scripts/push_study.py standing --seeds 1000 --levels 0.15 0.2

A push lasts 50 ms; its level is J / (m √(g h)) with the impulse J, the mass m and the height h
of the centre of mass. Eight directions by sixteen phases of two footsteps; survived is not to
lie 2.5 s later. Tune on seeds 0-99, report on seeds from 1000.
"""

import argparse
import copy
from math import sqrt

from hsr8.robots.loaded import load_robot
from walking.body.robot_model import RobotModel
from walking.command import HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD, GRAVITY, WalkingParameters

import mujoco
import numpy as np
from study_page import add_seeds
from walking_body import Body, Plant
from walking_trial import parameters_of

DIRECTIONS = ("forward", "fl", "left", "bl", "back", "br", "right", "fr")
PHASES = 16
LEAD = 2.5  # of walking before the first push [s]
PUSH = 0.05  # duration [s]
AFTER = 2.5  # [s]
SPEED = 0.1  # [m/s]


class Walker:
    """A body with its engine under one command."""

    def __init__(
        self,
        robot: RobotModel,
        parameters: WalkingParameters,
        rng: np.random.Generator,
        command: VelocityCommand,
    ) -> None:
        self._robot = robot
        self._engine = WalkingEngine(robot, parameters)
        self._body = Body(rng, Plant())
        self._command = command

    def __deepcopy__(self, memo: dict[int, object]) -> "Walker":
        twin = copy.copy(self)
        # The robot's numbers and the physical model never change.
        memo.update({id(o): o for o in (self._robot, self._body.model)})
        twin._engine = copy.deepcopy(self._engine, memo)
        twin._body = copy.deepcopy(self._body, memo)
        return twin

    def walk(self, seconds: float, force: np.ndarray | None = None) -> bool:
        """Walk on under a force on the torso [N]; whether the robot still stands then."""
        body = self._body
        body.data.xfrc_applied[body.torso, :2] = 0.0 if force is None else force
        for _ in range(round(seconds / CONTROL_PERIOD)):
            targets = self._engine.step(body.sense(), self._command, HeadTarget())
            body.apply(targets.setpoint)
            if body.fallen:
                return False
        return True


def unit_impulse() -> float:
    """Impulse of level one, m √(g h) [N s]."""
    body = Body(np.random.default_rng(0), Plant())
    mujoco.mj_comPos(body.model, body.data)
    height = float(body.data.subtree_com[0, 2])
    return float(body.model.body_subtreemass[0]) * sqrt(GRAVITY * height)


def survivors(
    parameters: WalkingParameters, speed: float, levels: list[float], seed: int
) -> np.ndarray:
    """Who survives (levels, directions, phases)."""
    robot = load_robot("hsr8").model
    gait, command = parameters.gait, VelocityCommand(speed, 0.0, 0.0)
    period, unit = 2.0 * gait.footstep_time, unit_impulse()
    result = np.zeros((len(levels), len(DIRECTIONS), PHASES), bool)
    for direction in range(len(DIRECTIONS)):
        angle = 2.0 * np.pi * direction / len(DIRECTIONS)
        heading = np.array([np.cos(angle), np.sin(angle)])
        rng = np.random.default_rng([seed, direction])
        walker = Walker(robot, parameters, rng, command)
        walker.walk(LEAD + rng.uniform() * period / PHASES)
        for phase in range(PHASES):
            walker.walk(period / PHASES)
            for row, level in enumerate(levels):
                pushed = copy.deepcopy(walker)
                force = level * unit / PUSH * heading
                result[row, direction, phase] = pushed.walk(PUSH, force) and pushed.walk(AFTER)
    return result


def main() -> None:
    """Run the study."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", choices=("walking", "standing"))
    add_seeds(parser)
    parser.add_argument("--levels", type=float, nargs="+", default=[0.15, 0.20, 0.25, 0.30])
    parser.add_argument("--set", nargs="*", default=[], help="parameters, group.name=value")
    options = parser.parse_args()
    speed = SPEED if options.study == "walking" else 0.0
    parameters = parameters_of(options.set)
    rows = np.stack([survivors(parameters, speed, options.levels, s) for s in options.seeds])
    print(f"{options.study}, seeds {options.seeds}: survivors of {rows[:, 0].size} a level")
    for level, row in zip(options.levels, rows.swapaxes(0, 1), strict=True):
        shares = row.mean(axis=(0, 2))
        parts = "  ".join(f"{n} {s:4.0%}" for n, s in zip(DIRECTIONS, shares, strict=True))
        print(f"{level:.2f}: {row.mean():6.1%}   {parts}", flush=True)


if __name__ == "__main__":
    main()
