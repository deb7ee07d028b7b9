"""First half of a control tick, and decisions that replace those of the robot in the second."""

from dataclasses import dataclass

import numpy as np

from hsr8.decisions import Situation
from hsr8.plugin_method import number
from hsr8.record import Second
from hsr8.robot import SensorFrame
from navigation.decision import GazeDecision, MotionDecision
from walking.signals import JointTargets


@dataclass(slots=True)
class BegunTick:
    """Control tick in which the robot has walked and perceived, but not yet decided.

    Attributes:
        seconds: states with hashes at its start.
        sensed: sensor readings.
        targets: setpoints of the walking engine; None if its plan diverged.
        walking_time: wall time of the walking engine [s].
        situation: situation that the robot decides in; None without a decision.
        diverged: reason why the plan diverged; empty if it did not.
        motion, gaze: decisions that replace those of the robot.
    """

    seconds: list[Second]
    sensed: SensorFrame
    targets: JointTargets | None
    walking_time: float
    situation: Situation | None
    diverged: str = ""
    motion: MotionDecision | None = None
    gaze: GazeDecision | None = None

    def look(self, pan: float, tilt: float) -> None:
        """Replace the gaze, see `hsr8.loop.Simulation.look`."""
        self._pending("look")
        self.gaze = GazeDecision(number(pan, "pan", "look"), number(tilt, "tilt", "look"))

    def command(self, vx: float, vy: float, wz: float) -> None:
        """Replace the motion, see `hsr8.loop.Simulation.command`."""
        if not self._pending("command").motion_due:
            raise RuntimeError("command: no motion is due; expected situation.motion_due")
        values = {"vx": vx, "vy": vy, "wz": wz}
        velocity = [number(value, key, "command") for key, value in values.items()]
        self.motion = MotionDecision(velocity=np.array(velocity))

    def _pending(self, method: str) -> Situation:
        if self.situation is None:
            raise RuntimeError(
                f"{method}: no decision is pending; expected a tick in which perceive() returned "
                "a situation"
            )
        return self.situation
