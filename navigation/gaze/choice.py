"""Choice of the gaze policy by its name."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navigation.decision import SpeedLimits
from navigation.gaze.blind import BlindGaze, SineSweep, StepSweep, TriangleSweep
from navigation.gaze.gaze_map import GazeGrid, Votes
from navigation.gaze.information import information_votes
from navigation.gaze.integrated import integrated_votes
from navigation.gaze.policy import GazeContext, GazePolicy
from navigation.gaze.risk import RiskGaze
from navigation.gaze.voting import VotingGaze
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
        limits: of the walking layer.
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
