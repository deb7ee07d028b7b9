"""State of the movers: on their nominal lanes, waiting for the robot, or a crowd.

Movers react every `REACTION_TICKS` control ticks. Until the next reaction every position is a
function of time, so that body, camera and recorder read the same state at any moment.
"""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hsr8.world.field.crowd import Crowd
from hsr8.world.field.layout import Layout
from hsr8.world.field.motion import Point

Array = NDArray[np.float64]

REACTION_TICKS = 4  # control ticks between reactions of the movers [1]

# A mover that yields, in a world of scale 1 and for a robot as fast as HSR-VIII:
YIELD_MARGIN = 0.10  # distance from the robot at which the mover waits [m]
LOOKAHEAD = 2.0  # time that it looks ahead on its lane [s]
SLOWING = 1.0  # time to the stop below which it slows down [s]
SAMPLES = 20  # positions ahead


class MovingField(Protocol):
    """Movers of a layout."""

    reacts: bool

    def react(self, time: float, robot: Point) -> None:
        """Let the movers react at `time` [s] to the position of the robot in W [m]."""

    def positions(self, times: float | Array) -> Array:
        """Return the positions at `times` (...) since the last reaction [s] (..., n, 2) [m]."""

    def velocities(self, times: float | Array) -> Array:
        """Return the velocities at `times` (...) since the last reaction [s] (..., n, 2) [m/s]."""

    def clocks(self, times: float | Array) -> Array:
        """Return the time of each mover on its lane (..., n) [s]; none where all follow time."""

    def state_bytes(self) -> bytes:
        """Return the state that determines the future together with time, for hashing."""


def moving_field(layout: Layout) -> MovingField:
    """Return the movers of a layout at time zero."""
    if layout.reactions.crowd:
        return Crowd(layout)
    return YieldingField(layout) if any(m.yields for m in layout.movers) else NominalField(layout)


class NominalField:
    """Movers that follow their lanes, whatever the robot does."""

    reacts = False

    def __init__(self, layout: Layout) -> None:
        self._movers = layout.motion()

    def react(self, time: float, robot: Point) -> None:
        pass

    def positions(self, times: float | Array) -> Array:
        return self._movers.positions(times)

    def velocities(self, times: float | Array) -> Array:
        return self._movers.velocities(times)

    def clocks(self, times: float | Array) -> Array:
        return np.zeros((*np.shape(times), 0))

    def state_bytes(self) -> bytes:
        return b""


class YieldingField:
    """Movers that slow down and wait while the robot is near and ahead on their own lane.

    The lane of a mover is unchanged; its clock goes slower. Along the next part of the lane, the
    first position nearer to the robot than radii and margin, and than the present one, is where the
    mover stops. A mover that departs from the robot never waits.
    """

    reacts = True

    def __init__(self, layout: Layout) -> None:
        movers, reactions = layout.movers, layout.reactions
        self._movers = layout.motion()
        self._yields = np.array([mover.yields for mover in movers])
        room = reactions.robot_radius + YIELD_MARGIN * layout.scale
        self._reach = np.array([mover.radius for mover in movers]) + room
        self._slowing = SLOWING * reactions.time_scale
        lookahead = LOOKAHEAD * reactions.time_scale
        self._ahead = np.linspace(0.0, lookahead, SAMPLES + 1)[:, None]
        self._far = self._reach + lookahead * self._movers.top_speeds()
        self._time = 0.0
        self._clocks, self._rates = np.zeros(len(movers)), np.ones(len(movers))

    def react(self, time: float, robot: Point) -> None:
        self._clocks, self._time = self.clocks(time), time
        gaps = np.hypot(*(self._movers.positions(time, self._clocks) - robot).T)
        self._rates = np.ones(len(gaps))
        if not (self._yields & (gaps < self._far)).any():
            return
        moments = np.full(SAMPLES + 1, time)
        ahead = self._movers.positions(moments, self._clocks + self._ahead) - robot
        distances = np.hypot(ahead[..., 0], ahead[..., 1])
        blocked = distances[1:] < np.minimum(self._reach, distances[0] - 1e-9)
        free_time = self._ahead[blocked.argmax(axis=0), 0]
        waits = self._yields & blocked.any(axis=0)
        self._rates[waits] = np.minimum(free_time[waits] / self._slowing, 1.0)

    def positions(self, times: float | Array) -> Array:
        return self._movers.positions(times, self.clocks(times))

    def velocities(self, times: float | Array) -> Array:
        velocities = self._movers.velocities(times, self.clocks(times))
        return self._rates[:, None] * velocities

    def clocks(self, times: float | Array) -> Array:
        elapsed = np.asarray(times, dtype=float)[..., None] - self._time
        clocks: Array = self._clocks + self._rates * elapsed
        return clocks

    def state_bytes(self) -> bytes:
        return self._clocks.tobytes() + self._rates.tobytes()
