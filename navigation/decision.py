"""Decisions of navigation: task, gaze and motion."""

import dataclasses
from dataclasses import dataclass
from math import hypot
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from compilation.value import value

Array = NDArray[np.float64]


def read_only(array: Array) -> Array:
    """Return a view that cannot be written to."""
    view = array.view()
    view.flags.writeable = False
    return view


Situation = Literal["free", "veto", "accelerate", "brake", "escape", "path_change"]
"""Why the motion differs from the desired one: it is free of conflicts; the safety filter replaced
it; or the outcome of velocity modification in the method of the paper."""


@dataclass(frozen=True, slots=True)
class SpeedLimits:
    """Speed limits of the walking layer, in R.

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
    """Next target of the mission.

    Attributes:
        target: destination in W (2,) [m].
        heading: heading to arrive with [rad].
        is_goal: whether it is the final goal, not a via point.
        index: number of via points passed.
        aligning: whether the robot is at the goal and turns to its heading.
        done: whether the mission is finished.
    """

    target: Array
    heading: float
    is_goal: bool
    index: int
    aligning: bool
    done: bool


@value
class GazeDecision:
    """Decision of the gaze.

    Attributes:
        pan, tilt: chosen gaze, left and up positive [rad].
        psi_lm, psi_sf, psi_ob, psi_way: partial evaluations in [0, 1]; psi_ob is the
            maximum over the obstacles.
        gaze_map: GM over (tilt, pan) cells (m, n).
        stabilized: whether the gaze keeps its direction in W while the body turns.
        body_direction: direction in W that the body turns to for a fixed camera; None with a
            head [rad].
    """

    pan: float
    tilt: float
    psi_lm: float = 0.0
    psi_sf: float = 0.0
    psi_ob: float = 0.0
    psi_way: float = 0.0
    gaze_map: Array = dataclasses.field(default_factory=lambda: np.zeros((1, 1)))
    stabilized: bool = False
    body_direction: float | None = None


@value
class VirtualObstacle:
    """Dynamic virtual obstacle (Yoo & Kim, eq. (11)).

    Attributes:
        position: p_vo in W (2,) [m].
        radius: R_vo [m].
        track_id: id of its mover.
    """

    position: Array
    radius: float
    track_id: int


class DirectionField(Protocol):
    """Vector field of a planner; evaluation has no side effects."""

    def at(self, points: Array) -> Array:
        """Return directions at `points` (..., 2) in W [m]: (..., 2), any length, or zero."""


@value
class MotionDecision:
    """Motion during the next footstep.

    Attributes:
        velocity: vx, vy, wz in R (3,) [m/s, m/s, rad/s].
        direction: desired direction in W [rad].
        speed: desired speed along it, before the safety filter [m/s].
        situation: why the motion differs from the desired one, see `Situation`; any text of a
            custom planner.
        virtual_obstacles: active virtual obstacles of the method of the paper.
        extended_radii: (track id, S_oe) of the obstacles in the field.
        field: vector field of the decision, for displays; None for a planner without one.
    """

    velocity: Array
    direction: float = 0.0
    speed: float = 0.0
    situation: str = "free"
    virtual_obstacles: tuple[VirtualObstacle, ...] = ()
    extended_radii: tuple[tuple[int, float], ...] = ()
    field: DirectionField | None = dataclasses.field(default=None, repr=False, compare=False)
