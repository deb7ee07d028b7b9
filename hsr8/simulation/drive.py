"""Driving: commands from outside, which replace the decisions of planner and gaze."""

from bisect import bisect_left
from collections.abc import Sequence
from math import isfinite
from typing import Any, TypeVar

from hsr8.simulation.decisions import DriveCommand, GazeController
from navigation.decision import GazeDecision, MotionDecision
from navigation.scene import Scene
from walking.command import VelocityCommand

T = TypeVar("T")

TIMEOUT = 0.5  # simulated time after which a velocity is no longer in force [s]
STANDING = DriveCommand(0.0, (0.0, 0.0, 0.0))


class Drive:
    """Commands from outside by time: a velocity up to a timeout, a gaze until the next.

    Args:
        commands: commands in the order of time; that of a driven run is never empty.
    """

    def __init__(self, commands: Sequence[DriveCommand] = (STANDING,)) -> None:
        self._velocities: list[tuple[float, VelocityCommand]] = []
        self._gazes: list[tuple[float, GazeDecision]] = []
        self._new: list[DriveCommand] = []
        for command in commands:
            self.add(command)

    def add(self, command: DriveCommand) -> None:
        """Add a command that arrived after all others."""
        self._new.append(command)
        if isfinite(command.velocity[0]):
            self._velocities.append((command.time, VelocityCommand(*command.velocity)))
        if isfinite(command.gaze[0]):
            self._gazes.append((command.time, GazeDecision(*command.gaze)))

    def take(self) -> tuple[DriveCommand, ...]:
        """Return the commands added since the last call."""
        new, self._new = tuple(self._new), []
        return new

    def at(self, time: float) -> VelocityCommand:
        """Return the velocity in force at `time` [s], zero after a timeout."""
        earlier, velocity = _before(self._velocities, time) or (time, VelocityCommand())
        return velocity if time - earlier <= TIMEOUT else VelocityCommand()

    def gaze(self, time: float) -> GazeDecision | None:
        """Return the gaze in force at `time` [s]; None before the first."""
        latest = _before(self._gazes, time)
        return latest and latest[1]


class DrivenGaze:
    """Gaze from outside; that of the scenario before the first.

    Args:
        gaze: gaze planner of the scenario.
        drive: commands from outside.
    """

    def __init__(self, gaze: GazeController, drive: Drive) -> None:
        self._gaze, self._drive = gaze, drive

    def begin(self) -> object:
        """Return the memory of the gaze planner at the start."""
        return self._gaze.begin()

    def choose(
        self, memory: Any, scene: Scene, motion: MotionDecision | None
    ) -> tuple[GazeDecision, object]:
        """Return the gaze in force, and the memory."""
        gaze = self._drive.gaze(scene.belief.time)
        return self._gaze.choose(memory, scene, motion) if gaze is None else (gaze, memory)


def _before(commands: list[tuple[float, T]], time: float) -> tuple[float, T] | None:
    """Return the latest command before `time` [s] with its time; None without one."""
    number = bisect_left(commands, time, key=lambda command: command[0])
    return commands[number - 1] if number else None
