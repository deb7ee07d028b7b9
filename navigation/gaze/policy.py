"""Protocol of gaze policies."""

from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from navigation.belief.belief import Belief
from navigation.gaze.scene import GazeScene

Array = NDArray[np.float64]
Memory = TypeVar("Memory")
Gaze = tuple[float, float]
"""Pan and tilt [rad]."""


class GazePolicy(Protocol[Memory]):
    """Choice of the gaze.

    A policy does not change; its memory is a value that every call takes and returns.

    Attributes:
        steady: whether the camera arrives and dwells before the next decision.
        stabilized: whether the gaze keeps its direction in W while the body turns.
    """

    steady: bool
    stabilized: bool

    def begin(self) -> Memory:
        """Return the memory of the start."""

    def observe(self, memory: Memory, belief: Belief) -> Memory:
        """Return the memory after a frame; called at every frame before `look`."""
        return memory

    def look(self, memory: Memory, scene: GazeScene, now: Gaze) -> tuple[Gaze, Array, Memory]:
        """Return the next gaze, the gaze map (tilts, pans) and the memory.

        Args:
            memory: memory of the policy.
            scene: belief, motion and partial evaluations.
            now: present gaze.
        """
