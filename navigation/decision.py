"""What navigation decides: where to look and how to move."""

import dataclasses
from dataclasses import dataclass
from math import hypot
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from navigation.value import value

Array = NDArray[np.float64]


Situation = Literal["free", "accelerate", "brake", "escape", "path_change"]
"""What velocity modification found."""


@dataclass(frozen=True, slots=True)
class SpeedLimits:
    """Speed envelope of the walking layer, in R.

    Attributes:
        vx, vx_backward, vy: maximum speeds forward, backward and sideways, all positive [m/s].
        wz: maximum turn rate [rad/s].
        acceleration: maximum acceleration [m/s²].
        footstep: duration of a footstep, for which a command is latched [s].
    """

    vx: float
    vx_backward: float
    vy: float
    wz: float
    acceleration: float
    footstep: float

    @property
    def max_speed(self) -> float:
        """Maximum speed in any direction [m/s]."""
        return hypot(max(self.vx, self.vx_backward), self.vy)


@value
class Task:
    """Where to go next.

    Attributes:
        target: destination in W (2,) [m].
        heading: heading to arrive with [rad].
        is_goal: final goal rather than a via point.
        index: number of via points passed so far.
        aligning: the goal is reached, only the heading is left to turn to.
        done: nothing is left to do.
    """

    target: Array
    heading: float
    is_goal: bool
    index: int
    aligning: bool
    done: bool


@value
class GazeDecision:
    """Where to look, and why.

    Attributes:
        pan, tilt: chosen gaze, left and up positive [rad].
        psi_lm, psi_sf, psi_ob, psi_way: partial evaluations in [0, 1]; psi_ob is the
            largest over the obstacles.
        gaze_map: GM over (tilt, pan) cells (m, n).
    """

    pan: float
    tilt: float
    psi_lm: float = 0.0
    psi_sf: float = 0.0
    psi_ob: float = 0.0
    psi_way: float = 0.0
    gaze_map: Array = dataclasses.field(default_factory=lambda: np.zeros((1, 1)))


@value
class VirtualObstacle:
    """Dynamic virtual obstacle (Yoo & Kim, eq. (11)).

    Attributes:
        position: p_vo in W (2,) [m].
        radius: R_vo [m].
        track_id: the mover it belongs to.
    """

    position: Array
    radius: float
    track_id: int


class DirectionField(Protocol):
    """Where a planner leads at any point; looking at it changes nothing."""

    def at(self, points: Array) -> Array:
        """Directions at `points` (..., 2) in W [m]: (..., 2), of any length, zero for none."""


@value
class MotionDecision:
    """How to move during the next footstep.

    Attributes:
        velocity: forward, left, turn in R (3,) [m/s, m/s, rad/s].
        direction: field direction u_T in W [rad].
        speed: speed along it after velocity modification [m/s].
        situation: what velocity modification found, see `Situation`; another planner tells its
            own.
        virtual_obstacles: in force.
        extended_radii: (track id, S_oe) of the obstacles the field uses.
        look_request: direction in W of ground that the body turned aside for; None for none [rad].
        field: what the direction was taken from, for those who watch; None for a planner that
            has no field.
    """

    velocity: Array
    direction: float = 0.0
    speed: float = 0.0
    situation: str = "free"
    virtual_obstacles: tuple[VirtualObstacle, ...] = ()
    extended_radii: tuple[tuple[int, float], ...] = ()
    look_request: float | None = None
    field: DirectionField | None = dataclasses.field(default=None, repr=False, compare=False)
