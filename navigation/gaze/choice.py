"""Choice of the gaze policy by its name."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navigation.decision import SpeedLimits
from navigation.gaze.blind import BlindGaze, SineSweep, StepSweep, TriangleSweep
from navigation.gaze.gaze_map import GazeGrid, Votes
from navigation.gaze.information import information_votes
from navigation.gaze.integrated import integrated_votes
from navigation.gaze.policy import Gaze, GazeContext, GazePolicy
from navigation.gaze.risk import RiskGaze
from navigation.parameters.gaze import GazeParameters
from navigation.parameters.navigation import NavigationParameters

Array = NDArray[np.float64]

BLIND = {
    "fixed": BlindGaze,
    "sweep": SineSweep,
    "triangle": TriangleSweep,
    "steps": StepSweep,
}


def gaze_policy(
    parameters: NavigationParameters,
    limits: SpeedLimits,
    grid: GazeGrid,
    beacons: Array,
    neck: tuple[float, float],
) -> GazePolicy:
    """Return the policy of `parameters.gaze.mode`.

    Args:
        parameters: profile.
        limits: speed limits of the walking layer.
        grid: cells of the gaze map.
        beacons: known positions in W (m, 2) [m].
        neck: maximum rate [rad/s] and acceleration [rad/s²] of the camera.
    """
    p = parameters.gaze
    if p.mode in BLIND:
        return BLIND[p.mode](parameters, grid)
    if p.mode == "risk":
        return RiskGaze(parameters, limits, grid, beacons, neck)
    weighted = replace(parameters, gaze=single_weight(p))

    def votes(c: GazeContext) -> Votes:
        if p.mode == "info":
            return information_votes(c.scene, parameters)
        return integrated_votes(c.scene, c.task, weighted)

    return VotingGaze(votes, grid, p.switch_ratio)


def search_policy(parameters: NavigationParameters, grid: GazeGrid) -> GazePolicy:
    """Return the policy of a lost robot, whose map does not show where the beacons are."""
    p = parameters.gaze
    if p.mode == "fixed" or p.moved_by == "body":
        return BlindGaze(parameters, grid)
    search = replace(p, mode="steps", sweep_amplitude=p.max_pan, sweep_stops=4, sweep_frames=2)
    return StepSweep(replace(parameters, gaze=search), grid)


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


class VotingGaze(GazePolicy):
    """Gaze at the highest centre of the gaze map.

    The gaze stays if the highest centre does not exceed it by the switch ratio. With a ratio of 1
    it always moves to the highest centre, as printed.

    Args:
        votes: voting rule.
        grid: cells of the gaze map.
        switch_ratio: gain in the gaze map that moves the gaze, at least 1.
    """

    steady = True
    stabilized = True

    def __init__(
        self, votes: Callable[[GazeContext], Votes], grid: GazeGrid, switch_ratio: float
    ) -> None:
        self._votes = votes
        self._grid = grid
        self._ratio = switch_ratio

    def look(self, context: GazeContext, now: Gaze) -> tuple[Array, Gaze]:
        gaze_map = self._grid.gaze_map(self._votes(context))
        if float(gaze_map.max()) >= self._ratio * self._grid.value_at(gaze_map, *now):
            return gaze_map, self._grid.highest_centre(gaze_map, *now)
        return gaze_map, now
