"""Votes of the four partial evaluations, Yoo & Kim, eqs. (1)-(6)."""

from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.decision import Task
from navigation.gaze.gaze_map import Votes
from navigation.gaze.scene import GazeScene
from navigation.parameters.gaze import GazeParameters
from navigation.parameters.navigation import NavigationParameters

Array = NDArray[np.float64]


def integrated_votes(
    scene: GazeScene, belief: Belief, task: Task, parameters: NavigationParameters
) -> Votes:
    """All votes of eq. (6), each with its weight and partial evaluation.

    Args:
        scene: partial evaluations of this moment.
        belief: what the robot believes.
        task: the way point.
        parameters: weights and forms.
    """
    p = parameters.gaze
    votes = map_votes(scene, p.w_lm, p.map_votes)
    votes.append(waypoint_vote(scene, belief, task, p.w_way, parameters))
    seen, pan, tilt = scene.aims(parameters)
    share = 1.0 / max(1, len(pan)) if p.obstacle_votes == "mean" else 1.0
    votes.append(Votes(pan, tilt, share * p.w_ob * scene.psi_ob[seen]))
    votes += self_votes(scene, pan, tilt, p)
    return Votes.join(votes)


def self_votes(scene: GazeScene, pan: Array, tilt: Array, p: GazeParameters) -> list[Votes]:
    """Votes of psi_sf in eq. (6) for what can localize the robot: obstacles, and beacons.

    The printed mean runs over both together, so that GM stays within [0, 1].
    """
    value, posts = p.w_sf * scene.psi_sf, len(scene.beacon_bearing)
    if p.candidates == "beacons":
        pan, tilt = pan[:0], tilt[:0]
    each, together = value, value
    if p.obstacle_votes == "mean":
        each = value / max(1, len(pan) + posts)
        together = posts * each
    beacons = beacon_votes(scene, together)
    within = np.clip(beacons.pan, -p.max_pan, p.max_pan)
    return [Votes(pan, tilt, np.full(len(pan), each)), Votes(within, beacons.tilt, beacons.value)]


def beacon_votes(scene: GazeScene, value: float) -> Votes:
    """One `value` shared by all beacons within reach, at the height of the horizon."""
    n = len(scene.beacon_bearing)
    return Votes(scene.beacon_bearing, np.zeros(n), np.full(n, value / max(1, n)))


def map_votes(scene: GazeScene, weight: float, form: str) -> list[Votes]:
    """Votes of psi_lm: `weight` at the mean under-confident point, or shared by all of them."""
    under = scene.map.under_confident
    count = int(under.sum())
    if count == 0:
        return []
    pan = scene.samples.bearing[under]
    tilt = -np.arctan2(scene.camera_height, scene.samples.distance[under])
    if form == "mean":
        return [Votes.one(float(pan.mean()), float(tilt.mean()), weight * scene.map.psi)]
    return [Votes(pan, tilt, np.full(count, weight * scene.map.psi / count))]


def waypoint_vote(
    scene: GazeScene, belief: Belief, task: Task, weight: float, parameters: NavigationParameters
) -> Votes:
    """Vote of psi_way towards the way point, on the floor; arguments as `integrated_votes`."""
    e, limit = parameters.evaluation, parameters.gaze.max_pan
    dx, dy = (task.target - belief.pose[:2]).tolist()
    bearing = wrap(atan2(dy, dx) - float(belief.pose[2]))
    distance = min(max(hypot(dx, dy), e.d_nm), e.d_fm)
    pan = min(max(bearing, -limit), limit)
    return Votes.one(pan, -atan2(scene.camera_height, distance), weight * scene.psi_way)
