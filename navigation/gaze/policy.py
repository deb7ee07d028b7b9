"""Gaze policies behind one protocol."""

from collections.abc import Callable
from dataclasses import replace
from math import atan2, hypot, pi, sin
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
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
    """Inputs of a gaze decision.

    Attributes:
        task: of the mission.
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
        steady: whether the head arrives and dwells before the next decision.
    """

    steady: bool

    def votes(self, context: GazeContext) -> Votes:
        """Return the votes of the gaze map."""

    def aim(self, context: GazeContext, gaze_map: Array, now: Gaze) -> Gaze:
        """Return the next gaze; `now` is the present one."""


class VotingGaze(GazePolicy):
    """Gaze at the highest centre of the gaze map.

    The gaze stays if the highest centre does not exceed it by the switch ratio. With a ratio of 1
    it always moves to the highest centre, as printed.
    """

    steady = True

    def __init__(
        self, votes: Callable[[GazeContext], Votes], grid: GazeGrid, switch_ratio: float
    ) -> None:
        """Initialize.

        Args:
            votes: voting rule.
            grid: cells of the gaze map.
            switch_ratio: gain in the gaze map that moves the gaze, at least 1.
        """
        self._votes = votes
        self._grid = grid
        self._ratio = switch_ratio

    def votes(self, context: GazeContext) -> Votes:
        return self._votes(context)

    def aim(self, context: GazeContext, gaze_map: Array, now: Gaze) -> Gaze:
        if float(gaze_map.max()) >= self._ratio * self._grid.value_at(gaze_map, *now):
            return self._grid.highest_centre(gaze_map, *now)
        return now


class FixedGaze(GazePolicy):
    """Gaze straight ahead. The map of (6) is computed for the log only."""

    steady = True

    def __init__(self, parameters: NavigationParameters) -> None:
        self._parameters = parameters

    def votes(self, context: GazeContext) -> Votes:
        return integrated_votes(context.scene, context.task, self._parameters)

    def aim(self, context: GazeContext, gaze_map: Array, now: Gaze) -> Gaze:
        return 0.0, self._parameters.gaze.fixed_tilt


class SweepGaze(FixedGaze):
    """Sinusoidal pan over time. The map of (6) is computed for the log only."""

    steady = False

    def aim(self, context: GazeContext, gaze_map: Array, now: Gaze) -> Gaze:
        p = self._parameters.gaze
        phase = 2.0 * pi * context.scene.belief.time / p.sweep_period
        return p.sweep_amplitude * sin(phase), p.fixed_tilt


def gaze_policy(
    parameters: NavigationParameters, limits: SpeedLimits, grid: GazeGrid
) -> GazePolicy:
    """Return the policy of `parameters.gaze.mode`.

    Args:
        parameters: profile.
        limits: of the walking layer.
        grid: cells of the gaze map.
    """
    p, speed = parameters.gaze, limits.vx
    if p.mode == "fixed":
        return FixedGaze(parameters)
    if p.mode == "sweep":
        return SweepGaze(parameters)
    weighted = replace(parameters, gaze=single_weight(p))
    votes: dict[str, Callable[[GazeContext], Votes]] = {
        "deadline": lambda c: _deadline_votes(c, speed, parameters),
        "urgency": lambda c: urgency_votes(c.scene, c.task, c.path, speed, parameters),
        "info": lambda c: information_votes(c.scene, parameters),
    }
    return VotingGaze(
        votes.get(p.mode, lambda c: integrated_votes(c.scene, c.task, weighted)),
        grid,
        p.deadline.switch_ratio if p.mode == "deadline" else p.switch_ratio,
    )


def _deadline_votes(c: GazeContext, speed: float, parameters: NavigationParameters) -> Votes:
    turn_rate, request = 0.0, None
    if c.motion is not None:
        turn_rate, request = float(c.motion.velocity[2]), c.motion.look_request
    return deadline_votes(
        c.scene, c.path, speed, parameters, look_request=request, turn_rate=turn_rate
    )


def single_weight(p: GazeParameters) -> GazeParameters:
    """Return the weights of (6) for `p.mode`: one for a single evaluation, else all of `p`."""
    if not p.mode.startswith("psi-"):
        return p
    return replace(
        p,
        w_lm=float(p.mode == "psi-lm"),
        w_sf=float(p.mode == "psi-sf"),
        w_ob=float(p.mode == "psi-ob"),
        w_way=float(p.mode == "psi-way"),
    )
