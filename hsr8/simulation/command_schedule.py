"""Command schedule: velocity and footstep commands by time, for walks without navigation."""

from bisect import bisect_right
from collections.abc import Sequence
from math import atan2, cos, hypot, inf, sin
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.mission import Command as CommandSection
from hsr8.scenario.mission import RandomCommands, Stretch
from navigation.decision import MotionDecision, Task
from navigation.scene import Scene
from walking.command import Command, CommandState, VelocityCommand

Array = NDArray[np.float64]

ROUNDING = 1e-9  # of simulated time [s]


class CommandSchedule:
    """Commands by time.

    Args:
        pieces: duration [s] and command, in order; after the last one the robot stands still.
    """

    def __init__(self, pieces: Sequence[tuple[float, Command]]) -> None:
        self._starts = np.cumsum([0.0, *(duration for duration, _ in pieces)]).tolist()
        self._commands = [*(command for _, command in pieces), VelocityCommand()]

    def at(self, time: float) -> Command:
        """Return the command in force at `time` [s]."""
        return self._commands[max(0, bisect_right(self._starts, time + ROUNDING) - 1)]


def command_schedule(
    section: CommandSection, duration: float, rng: np.random.Generator
) -> CommandSchedule:
    """Return the schedule of a scenario's section ``command``.

    Args:
        section: section of the scenario.
        duration: duration of the run [s].
        rng: draws random commands.
    """
    if section.constant:
        velocity = VelocityCommand(section.vx or 0.0, section.vy or 0.0, section.wz or 0.0)
        return CommandSchedule([(inf, velocity)])
    if section.footstep is not None:
        return CommandSchedule([(inf, CommandState(**section.footstep.model_dump()))])
    if section.random is not None:
        return CommandSchedule(_drawn(section.random, duration, rng))
    return CommandSchedule([(s.duration, _command(s)) for s in section.stretch])


def _command(stretch: Stretch) -> Command:
    if stretch.footstep is None:
        return VelocityCommand(stretch.vx, stretch.vy, stretch.wz)
    return CommandState(**stretch.footstep.model_dump())


def _drawn(
    random: RandomCommands, duration: float, rng: np.random.Generator
) -> list[tuple[float, Command]]:
    pieces: list[tuple[float, Command]] = []
    end = 0.0
    while end < duration:
        interval = float(rng.uniform(*random.interval))
        stop = rng.uniform() < random.stop_fraction
        velocity = [float(rng.uniform(*bounds)) for bounds in (random.vx, random.vy, random.wz)]
        pieces.append((interval, VelocityCommand() if stop else VelocityCommand(*velocity)))
        end += interval
    return pieces


class CommandSource(Protocol):
    """Source of commands by time."""

    def at(self, time: float) -> Command:
        """Return the command in force at `time` [s]."""


class ScheduledMission:
    """Mission without destination: never done, with a target straight ahead for the gaze."""

    def update(self, pose: Array) -> Task:
        """Return the task at the believed pose (3,)."""
        x, y, yaw = pose.tolist()
        ahead = np.array([x + cos(yaw), y + sin(yaw)])
        return Task(ahead, yaw, is_goal=False, index=0, aligning=False, done=False)


class ScheduledPlanner:
    """Motion planner that reports the scheduled velocity, whatever the robot believes.

    Args:
        schedule: commands by time.
    """

    def __init__(self, schedule: CommandSource) -> None:
        self._schedule = schedule

    def begin(self) -> None:
        """Return the memory, which is empty."""

    def plan(self, memory: None, scene: Scene) -> tuple[MotionDecision, None]:
        """Return the velocity in force."""
        belief = scene.belief
        vx, vy, wz = self._schedule.at(belief.time).velocity
        decision = MotionDecision(
            velocity=np.array([vx, vy, wz]),
            direction=float(belief.pose[2]) + atan2(vy, vx),
            speed=hypot(vx, vy),
        )
        return decision, None
