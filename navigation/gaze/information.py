"""Greedy information gain: a look is worth what it is expected to tell, in nats.

Nothing but what the robot is unsure of counts: tracks, pose and ground, each by how much
one detection would shrink its entropy. Where the robot walks and how soon it could touch
something does not enter. The gains of what one gaze shows are added.
"""

import numpy as np
from numpy.typing import NDArray

from navigation.belief.belief import Belief
from navigation.gaze.gaze_map import Votes
from navigation.gaze.scene import GazeScene, relative
from navigation.parameters.navigation import NavigationParameters
from navigation.transform import points_to_world

Array = NDArray[np.float64]


def information_votes(scene: GazeScene, belief: Belief, parameters: NavigationParameters) -> Votes:
    """The gain of every track, beacon and patch of ground, where it is to be had.

    Args:
        scene: what could be looked at.
        belief: what the robot believes.
        parameters: of the decisions.
    """
    return Votes.join(
        [
            track_information(scene, belief, parameters),
            pose_information(scene, belief, parameters),
            ground_information(scene, belief, parameters),
        ]
    )


def track_information(scene: GazeScene, belief: Belief, parameters: NavigationParameters) -> Votes:
    """½ log det(1 + P/R) of every track; a lost one offers its share at every particle."""
    place, share, variance = [], [], []
    for track in belief.tracks:
        cloud = track.particles
        place.append(track.position[None] if cloud is None else cloud.positions)
        share.append(np.ones(1) if cloud is None else cloud.weights)
        spread = np.linalg.eigvalsh(track.covariance[:2, :2])
        variance.append(np.broadcast_to(np.maximum(spread, 0.0), (len(place[-1]), 2)))
    if not place:
        return Votes.join([])
    bearing, distance = relative(np.concatenate(place), belief.pose)
    near = distance <= parameters.evaluation.attention_range
    noise = sight_sigma(distance, parameters) ** 2
    ratio = np.concatenate(variance) / noise[:, None]
    gain = np.concatenate(share) * 0.5 * np.log1p(ratio).sum(axis=1)
    height = parameters.evaluation.aim_height - scene.camera_height
    tilt = np.arctan2(height, np.maximum(distance, parameters.evaluation.min_distance))
    return Votes(bearing[near], tilt[near], gain[near])


def pose_information(scene: GazeScene, belief: Belief, parameters: NavigationParameters) -> Votes:
    """½ log det(1 + R⁻¹ H P Hᵀ) of every beacon, H of its range and bearing."""
    bearing, distance = scene.beacon_bearing, scene.beacon_distance
    direction = bearing + belief.pose[2]
    c, s = np.cos(direction), np.sin(direction)
    zero = np.zeros_like(c)
    # Both rows in metres: along the line of sight, and across it.
    rows = np.stack(
        [np.stack([-c, -s, zero], axis=1), np.stack([s, -c, -distance], axis=1)], axis=1
    )
    innovation = rows @ belief.pose_covariance @ rows.transpose(0, 2, 1)
    ratio = innovation / sight_sigma(distance, parameters)[:, None, None] ** 2
    gain = 0.5 * np.linalg.slogdet(np.eye(2) + ratio)[1]
    return Votes(bearing, np.zeros(len(bearing)), gain)


def ground_information(scene: GazeScene, belief: Belief, parameters: NavigationParameters) -> Votes:
    """Entropy of whether anything has come to stand on a patch since it was seen."""
    confidence = belief.local_map.confidence_at(points_to_world(belief.pose, scene.samples.points))
    chance = np.clip(parameters.gaze.information.presence * (1.0 - confidence), 1e-9, 1.0 - 1e-9)
    gain = -chance * np.log(chance) - (1.0 - chance) * np.log1p(-chance)
    tilt = -np.arctan2(scene.camera_height, scene.samples.distance)
    return Votes(scene.samples.bearing, tilt, gain)


def sight_sigma(distance: Array, parameters: NavigationParameters) -> Array:
    """Standard deviation of a place seen at `distance` (n,) [m]."""
    p = parameters.gaze.information
    sigma: Array = p.sight_sigma + p.sight_rate * distance
    return sigma
