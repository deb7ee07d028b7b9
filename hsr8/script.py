"""A walk without navigation: the commands come from the scenario, one after the other."""

from bisect import bisect_right
from collections.abc import Sequence
from math import atan2, cos, hypot, inf, sin

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.command import Command as Asked
from hsr8.scenario.command import Footsteps, RandomCommands
from navigation.belief.belief import Belief
from navigation.decision import MotionDecision, Task
from walking.command import Command, CommandState, VelocityCommand

Array = NDArray[np.float64]

ROUNDING = 1e-9  # of simulated time [s]


class CommandScript:
    """Commands by time.

    Args:
        pieces: duration [s] and command, in order; after the last the robot stands.
    """

    def __init__(self, pieces: Sequence[tuple[float, Command]]) -> None:
        self._starts = np.cumsum([0.0, *(duration for duration, _ in pieces)]).tolist()
        self._commands = [*(command for _, command in pieces), VelocityCommand()]

    def at(self, time: float) -> Command:
        """The command in force at `time` [s]."""
        return self._commands[max(0, bisect_right(self._starts, time + ROUNDING) - 1)]


def command_script(asked: Asked, duration: float, rng: np.random.Generator) -> CommandScript:
    """The script of a scenario that lasts `duration` [s]; `rng` draws what is drawn."""
    if asked.constant:
        velocity = VelocityCommand(asked.vx or 0.0, asked.vy or 0.0, asked.wz or 0.0)
        return CommandScript([(inf, velocity)])
    if asked.footstep is not None:
        return CommandScript([(inf, _command_state(asked.footstep))])
    if asked.random is not None:
        return CommandScript(_drawn(asked.random, duration, rng))
    return CommandScript(
        [
            (
                s.duration,
                VelocityCommand(s.vx, s.vy, s.wz)
                if s.footstep is None
                else _command_state(s.footstep),
            )
            for s in asked.stretch
        ]
    )


def _drawn(
    random: RandomCommands, duration: float, rng: np.random.Generator
) -> list[tuple[float, Command]]:
    pieces: list[tuple[float, Command]] = []
    end = 0.0
    while end < duration:
        held = float(rng.uniform(*random.interval))
        stop = rng.uniform() < random.stops
        velocity = [float(rng.uniform(*bounds)) for bounds in (random.vx, random.vy, random.wz)]
        pieces.append((held, VelocityCommand() if stop else VelocityCommand(*velocity)))
        end += held
    return pieces


def _command_state(step: Footsteps) -> CommandState:
    return CommandState(
        single_support=step.single_support,
        double_support=step.double_support,
        forward=step.forward,
        side=step.side,
        direction=step.direction,
        swing_height=step.swing_height,
    )


class ScriptedMission:
    """Nowhere to go and never done."""

    def update(self, pose: Array) -> Task:
        """A target straight ahead, so that the gaze has somewhere to look."""
        x, y, yaw = pose.tolist()
        ahead = np.array([x + cos(yaw), y + sin(yaw)])
        return Task(ahead, yaw, is_goal=False, index=0, aligning=False, done=False)


class ScriptedPlanner:
    """Tells the script as a motion decision, whatever the robot believes.

    Args:
        script: commands by time.
    """

    def __init__(self, script: CommandScript) -> None:
        self._script = script

    def plan(self, belief: Belief, task: Task) -> MotionDecision:
        """The velocity in force now."""
        vx, vy, wz = self._script.at(belief.time).velocity
        return MotionDecision(
            velocity=np.array([vx, vy, wz]),
            direction=float(belief.pose[2]) + atan2(vy, vx),
            speed=hypot(vx, vy),
        )
