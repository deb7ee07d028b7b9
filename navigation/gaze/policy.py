"""Protocol of gaze policies, and the inputs of their decisions."""

from math import atan2, hypot
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.decision import MotionDecision, Task
from navigation.gaze.scene import GazeScene

Array = NDArray[np.float64]
Gaze = tuple[float, float]
"""Pan and tilt [rad]."""


@value
class GazeContext:
    """Inputs of a gaze decision.

    Attributes:
        task: task of the mission.
        motion: decision of the planner, None before the first.
        scene: belief and partial evaluations.
    """

    task: Task
    motion: MotionDecision | None
    scene: GazeScene

    @property
    def path(self) -> float:
        """Bearing of the planned velocity in R, of the destination if that is zero [rad]."""
        if self.motion is not None:
            vx, vy, _ = self.motion.velocity.tolist()
            if hypot(vx, vy) > 1e-3:
                return atan2(vy, vx)
        pose = self.scene.belief.pose
        dx, dy = (self.task.target - pose[:2]).tolist()
        return wrap(atan2(dy, dx) - float(pose[2]))


class GazePolicy(Protocol):
    """Choice of the gaze.

    Attributes:
        steady: whether the camera arrives and dwells before the next decision.
        stabilized: whether the gaze keeps its direction in W while the body turns.
    """

    steady: bool
    stabilized: bool

    def observe(self, belief: Belief) -> None:
        """Update what the policy remembers; called at every frame before `look`."""
        return None  # a policy without a memory

    def look(self, context: GazeContext, now: Gaze) -> tuple[Array, Gaze]:
        """Return the gaze map (tilts, pans) and the next gaze; `now` is the present one."""
