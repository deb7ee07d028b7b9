"""Blind gazes: they move the head by time alone. Their gaze map (6) is for displays only."""

from math import pi, sin

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.gaze.gaze_map import GazeGrid
from navigation.gaze.integrated import integrated_votes
from navigation.gaze.policy import Gaze, GazeContext, GazePolicy
from navigation.parameters.gaze import GazeParameters
from navigation.parameters.navigation import NavigationParameters

Array = NDArray[np.float64]

MAX_STOP_TIME = 2.0  # time after which a stop ends that the head does not reach [s]
STOP_TOLERANCE = 0.1  # distance from a stop at which the head has arrived [rad]


class BlindGaze(GazePolicy):
    """Gaze that depends on time alone; this one looks straight ahead.

    Args:
        parameters: parameters of the decisions.
        grid: cells of the gaze map.
    """

    def __init__(self, parameters: NavigationParameters, grid: GazeGrid) -> None:
        self._parameters = parameters
        self._grid = grid
        self.steady = parameters.gaze.mode == "fixed"
        self.stabilized = False

    def look(self, context: GazeContext, now: Gaze) -> tuple[Array, Gaze]:
        votes = integrated_votes(context.scene, context.task, self._parameters)
        pan = self.pan(context.scene.belief)
        return self._grid.gaze_map(votes), (pan, self._parameters.gaze.fixed_tilt)

    def pan(self, belief: Belief) -> float:
        """Return the pan at the time of `belief` [rad]."""
        return 0.0


class SineSweep(BlindGaze):
    """Sinusoidal pan."""

    def pan(self, belief: Belief) -> float:
        p = self._parameters.gaze
        return p.sweep_amplitude * sin(2.0 * pi * belief.time / p.sweep_period)


class TriangleSweep(BlindGaze):
    """Pan at a constant rate to either side."""

    def pan(self, belief: Belief) -> float:
        p = self._parameters.gaze
        phase = (belief.time / p.sweep_period + 0.25) % 1.0
        return p.sweep_amplitude * (1.0 - 4.0 * abs(phase - 0.5))


class StepSweep(BlindGaze):
    """Stops from one side to the other and back, each for a number of sharp frames."""

    def __init__(self, parameters: NavigationParameters, grid: GazeGrid) -> None:
        super().__init__(parameters, grid)
        self.steady, self.stabilized = False, True
        self._stops = stops(parameters.gaze)
        self._current, self._frames = 0, 0
        self._direction = 0.0  # of the present stop in W [rad]
        self._since: float | None = None

    def pan(self, belief: Belief) -> float:
        heading = float(belief.pose[2])
        if self._since is None:
            self._direction, self._since = heading + self._stops[0], belief.time
        target = wrap(self._direction - heading)
        if not belief.view.blind and abs(belief.view.pan - target) < STOP_TOLERANCE:
            self._frames += 1
        late = belief.time - self._since > MAX_STOP_TIME
        if self._frames >= self._parameters.gaze.sweep_frames or late:
            self._current = (self._current + 1) % len(self._stops)
            self._frames, self._since = 0, belief.time
            self._direction = heading + self._stops[self._current]
        limit = self._parameters.gaze.max_pan
        return min(max(wrap(self._direction - heading), -limit), limit)


def stops(parameters: GazeParameters) -> list[float]:
    """Return the pans of one cycle of the step sweep, to one side and back [rad]."""
    p = parameters
    across = np.linspace(-p.sweep_amplitude, p.sweep_amplitude, p.sweep_stops).tolist()
    return [*across, *across[-2:0:-1]]
