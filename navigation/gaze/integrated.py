"""Votes of the four partial evaluations, Yoo & Kim, eqs. (1)-(6)."""

from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.decision import Task
from navigation.gaze.gaze_map import Votes
from navigation.gaze.scene import GazeScene
from navigation.parameters.gaze import GazeParameters
from navigation.parameters.navigation import NavigationParameters

Array = NDArray[np.float64]


def integrated_votes(scene: GazeScene, task: Task, parameters: NavigationParameters) -> Votes:
    """Return all votes of eq. (6), each with its weight and partial evaluation.

    Args:
        scene: partial evaluations.
        task: waypoint.
        parameters: weights and forms.
    """
    p = parameters.gaze
    votes = map_votes(scene, p.w_lm, p.map_votes)
    votes.append(waypoint_vote(scene, task, p.w_way, parameters))
    members, pan, tilt = scene.aims(parameters)
    fraction = 1.0 / max(1, len(pan)) if p.obstacle_votes == "mean" else 1.0
    votes.append(Votes(pan, tilt, fraction * p.w_ob * scene.psi_ob[members]))
    votes += self_votes(scene, pan, tilt, p)
    return Votes.join(votes)


def self_votes(scene: GazeScene, pan: Array, tilt: Array, p: GazeParameters) -> list[Votes]:
    """Return the votes of psi_sf in eq. (6) for obstacles and beacons, which localize the robot.

    The printed mean runs over both together, so that GM stays within [0, 1].
    """
    value, beacon_count = p.w_sf * scene.psi_sf, len(scene.beacon_bearing)
    if p.candidates == "beacons":
        pan, tilt = pan[:0], tilt[:0]
    each, together = value, value
    if p.obstacle_votes == "mean":
        each = value / max(1, len(pan) + beacon_count)
        together = beacon_count * each
    # The beacons share one value, at the height of the horizon.
    within = np.clip(scene.beacon_bearing, -p.max_pan, p.max_pan)
    beacons = np.full(beacon_count, together / max(1, beacon_count))
    return [
        Votes(pan, tilt, np.full(len(pan), each)),
        Votes(within, np.zeros(beacon_count), beacons),
    ]


def map_votes(scene: GazeScene, weight: float, form: str) -> list[Votes]:
    """Return the votes of psi_lm: at the mean under-confident point, or split among all."""
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
    scene: GazeScene, task: Task, weight: float, parameters: NavigationParameters
) -> Votes:
    """Return the vote of psi_way for the floor towards the waypoint."""
    e, limit, pose = parameters.evaluation, parameters.gaze.max_pan, scene.belief.pose
    dx, dy = (task.target - pose[:2]).tolist()
    bearing = wrap(atan2(dy, dx) - float(pose[2]))
    distance = min(max(hypot(dx, dy), e.d_nm), e.d_fm)
    pan = min(max(bearing, -limit), limit)
    return Votes.one(pan, -atan2(scene.camera_height, distance), weight * scene.psi_way)
