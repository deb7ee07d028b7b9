"""The ways to choose a gaze, one name each, behind one protocol."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import atan2, hypot, pi, sin
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.decision import MotionDecision, SpeedLimits, Task
from navigation.gaze.deadline import deadline_votes
from navigation.gaze.gaze_map import GazeGrid, Votes
from navigation.gaze.information import information_votes
from navigation.gaze.integrated import integrated_votes
from navigation.gaze.scene import GazeScene
from navigation.gaze.urgency import urgency_votes
from navigation.parameters.gaze import GazeParameters
from navigation.parameters.navigation import NavigationParameters
from navigation.value import value

Array = NDArray[np.float64]
Gaze = tuple[float, float]
"""Pan and tilt [rad]."""


@value
class GazeContext:
    """Everything a gaze may depend on.

    Attributes:
        belief: what the robot believes.
        task: where it goes.
        motion: how it moves, None before the first plan.
        scene: partial evaluations.
    """

    belief: Belief
    task: Task
    motion: MotionDecision | None
    scene: GazeScene


class GazePolicy(Protocol):
    """One way to choose the gaze.

    Attributes:
        steady: lets the head arrive and rest before it decides again.
    """

    steady: bool

    def votes(self, context: GazeContext) -> Votes:
        """What fills the gaze map."""

    def aim(self, context: GazeContext, gaze_map: Array, now: Gaze) -> Gaze:
        """Where to look next, `now` being the gaze in force."""


class VotingGaze:
    """Looks at the highest centre of the gaze map, if that is worth the move."""

    steady = True

    def __init__(
        self, votes: Callable[[GazeContext], Votes], grid: GazeGrid, switch_ratio: float
    ) -> None:
        """Store how votes are cast.

        Args:
            votes: cast in a context.
            grid: cells of the gaze map.
            switch_ratio: gain in the gaze map that moves the gaze, at least 1.
        """
        self.votes = votes
        self._grid = grid
        self._ratio = switch_ratio

    def aim(self, context: GazeContext, gaze_map: Array, now: Gaze) -> Gaze:
        """The highest centre, or `now` if that sees about as much.

        At a ratio of 1 it is always the highest centre, as printed.
        """
        if float(gaze_map.max()) >= self._ratio * self._grid.value_at(gaze_map, *now):
            return self._grid.highest_centre(gaze_map, *now)
        return now


class FixedGaze:
    """Looks ahead and never moves. The map of (6) is still computed, for the log only."""

    steady = True

    def __init__(self, parameters: NavigationParameters) -> None:
        """Store the tilt and what the map is made of."""
        self._parameters = parameters

    def votes(self, context: GazeContext) -> Votes:
        """The paper's, to see what the gaze misses."""
        return integrated_votes(context.scene, context.belief, context.task, self._parameters)

    def aim(self, context: GazeContext, gaze_map: Array, now: Gaze) -> Gaze:
        """Straight ahead."""
        return 0.0, self._parameters.gaze.fixed_tilt


class SweepGaze(FixedGaze):
    """Swings from side to side by the clock. The map of (6) is computed for the log only."""

    steady = False

    def aim(self, context: GazeContext, gaze_map: Array, now: Gaze) -> Gaze:
        """A sine of the time."""
        p = self._parameters.gaze
        phase = 2.0 * pi * context.belief.time / p.sweep_period
        return p.sweep_amplitude * sin(phase), p.fixed_tilt


def gaze_policy(
    parameters: NavigationParameters, limits: SpeedLimits, grid: GazeGrid
) -> GazePolicy:
    """The policy that `parameters.gaze.mode` names.

    Args:
        parameters: profile.
        limits: envelope of the walking layer.
        grid: cells of the gaze map.
    """
    p = parameters.gaze
    if p.mode == "fixed":
        return FixedGaze(parameters)
    if p.mode == "sweep":
        return SweepGaze(parameters)
    if p.mode == "deadline":
        votes = partial(_deadline, parameters, limits.vx)
        return VotingGaze(votes, grid, p.deadline.switch_ratio)
    if p.mode == "urgency":
        votes = partial(_urgency, parameters, limits.vx)
    elif p.mode == "info":
        votes = partial(_information, parameters)
    else:
        votes = partial(_integrated, replace(parameters, gaze=single_weight(p)))
    return VotingGaze(votes, grid, p.switch_ratio)


# Functions with names, so that a gaze can be saved in the middle of a run.
def _deadline(parameters: NavigationParameters, speed: float, m: GazeContext) -> Votes:
    way = path_bearing(m)
    if m.motion is None:
        return deadline_votes(m.scene, m.belief, way, speed, parameters)
    turn, look_request = float(m.motion.velocity[2]), m.motion.look_request
    return deadline_votes(
        m.scene, m.belief, way, speed, parameters, look_request=look_request, turn=turn
    )


def _urgency(parameters: NavigationParameters, speed: float, m: GazeContext) -> Votes:
    way = path_bearing(m)
    return urgency_votes(m.scene, m.belief, m.task, way=way, speed=speed, parameters=parameters)


def _information(parameters: NavigationParameters, m: GazeContext) -> Votes:
    return information_votes(m.scene, m.belief, parameters)


def _integrated(parameters: NavigationParameters, m: GazeContext) -> Votes:
    return integrated_votes(m.scene, m.belief, m.task, parameters)


def single_weight(p: GazeParameters) -> GazeParameters:
    """The weights of (6) for `p.mode`: all of `p`, or one for the evaluation it names alone."""
    if p.mode == "integrated":
        return p
    return replace(
        p,
        w_lm=float(p.mode == "psi-lm"),
        w_sf=float(p.mode == "psi-sf"),
        w_ob=float(p.mode == "psi-ob"),
        w_way=float(p.mode == "psi-way"),
    )


def path_bearing(context: GazeContext) -> float:
    """Bearing of the planned velocity in R, of the destination while standing [rad]."""
    if context.motion is not None:
        forward, left, _ = context.motion.velocity.tolist()
        if hypot(forward, left) > 1e-3:
            return atan2(left, forward)
    pose = context.belief.pose
    dx, dy = (context.task.target - pose[:2]).tolist()
    return wrap(atan2(dy, dx) - float(pose[2]))
