"""Blind gazes: they move the head by time alone. Their gaze map is zero."""

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.decision import read_only
from navigation.gaze.grid import GazeGrid
from navigation.gaze.policy import Gaze, GazePolicy
from navigation.gaze.scene import GazeScene
from navigation.parameters.gaze import GazeParameters

Array = NDArray[np.float64]

MAX_STOP_TIME = 2.0  # time after which a stop ends that the head does not reach [s]
STOP_TOLERANCE = 0.1  # distance from a stop at which the head has arrived [rad]


class BlindGaze(GazePolicy[None]):
    """Gaze that depends on time alone; this one looks straight ahead.

    Args:
        parameters: parameters of the gaze.
        grid: cells of the gaze map.
    """

    steady = False
    stabilized = False

    def __init__(self, parameters: GazeParameters, grid: GazeGrid) -> None:
        self._parameters = parameters
        self._map = no_votes(grid)

    def begin(self) -> None:
        return None

    def look(self, memory: None, scene: GazeScene, now: Gaze) -> tuple[Gaze, Array, None]:
        return (self.pan(scene.belief.time), self._parameters.fixed_tilt), self._map, None

    def pan(self, time: float) -> float:
        """Return the pan at `time` [s] [rad]."""
        return 0.0


class TriangleSweep(BlindGaze):
    """Pan at a constant rate to either side."""

    def pan(self, time: float) -> float:
        p = self._parameters
        phase = (time / p.sweep_period + 0.25) % 1.0
        return p.sweep_amplitude * (1.0 - 4.0 * abs(phase - 0.5))


@value
class Stop:
    """Present stop of a step sweep.

    Attributes:
        number: number of the stop in the cycle.
        direction: direction of the stop in W [rad].
        since: time of the beginning of the stop [s].
        frames: number of sharp frames so far.
    """

    number: int
    direction: float
    since: float
    frames: int = 0


class StepSweep(GazePolicy[Stop | None]):
    """Stops from one side to the other and back, each for a number of sharp frames.

    Args:
        parameters: parameters of the gaze.
        grid: cells of the gaze map.
    """

    steady = False
    stabilized = True

    def __init__(self, parameters: GazeParameters, grid: GazeGrid) -> None:
        self._parameters = parameters
        self._map = no_votes(grid)
        self._stops = stops(parameters)

    def begin(self) -> None:
        return None

    def look(
        self, memory: Stop | None, scene: GazeScene, now: Gaze
    ) -> tuple[Gaze, Array, Stop | None]:
        p, belief = self._parameters, scene.belief
        stop = self._begun(0, belief) if memory is None else memory
        heading, view = float(belief.pose[2]), belief.view
        sharp = not view.blind and abs(view.pan - wrap(stop.direction - heading)) < STOP_TOLERANCE
        frames = stop.frames + int(sharp)
        if frames >= p.sweep_frames or belief.time - stop.since > MAX_STOP_TIME:
            stop = self._begun((stop.number + 1) % len(self._stops), belief)
        else:
            stop = Stop(stop.number, stop.direction, stop.since, frames)
        pan = min(max(wrap(stop.direction - heading), -p.max_pan), p.max_pan)
        return (pan, p.fixed_tilt), self._map, stop

    def _begun(self, number: int, belief: Belief) -> Stop:
        return Stop(number, float(belief.pose[2]) + self._stops[number], belief.time)


def no_votes(grid: GazeGrid) -> Array:
    """Return a gaze map without votes (tilts, pans), read-only."""
    return read_only(np.zeros((len(grid.tilt), len(grid.pan))))


def stops(parameters: GazeParameters) -> list[float]:
    """Return the pans of one cycle of the step sweep, to one side and back [rad]."""
    p = parameters
    across = np.linspace(-p.sweep_amplitude, p.sweep_amplitude, p.sweep_stops).tolist()
    return [*across, *across[-2:0:-1]]
