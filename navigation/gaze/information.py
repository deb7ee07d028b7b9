"""Greedy information gain: expected entropy reduction by one look, in nats.

The gain of tracks, pose and ground is the expected entropy reduction by one detection. It does not
depend on the path of the robot or the time to collision. The gains in one view are added.
"""

import numpy as np
from numpy.typing import NDArray

from navigation.belief.tracks import Tracks
from navigation.gaze.gaze_map import Votes
from navigation.gaze.scene import GazeScene, relative
from navigation.parameters.navigation import NavigationParameters
from navigation.transform import points_to_world

Array = NDArray[np.float64]


def information_votes(scene: GazeScene, parameters: NavigationParameters) -> Votes:
    """Return the gain of every track, beacon and sample point of the ground."""
    return Votes.join(
        [
            track_information(scene, parameters),
            pose_information(scene, parameters),
            ground_information(scene, parameters),
        ]
    )


def track_information(scene: GazeScene, parameters: NavigationParameters) -> Votes:
    """½ log det(1 + P/R) of every track; that of a lost track is split over its particles."""
    tracks = Tracks.of(scene.belief.tracks)
    owner, positions, weights = tracks.possible_positions()
    spread = np.linalg.eigvalsh(tracks.rows["covariance"][:, :2, :2])
    variances = np.maximum(spread, 0.0)[owner]
    bearing, distance = relative(positions, scene.belief.pose)
    near = distance <= parameters.evaluation.attention_range
    noise = sight_sigma(distance, parameters) ** 2
    ratio = variances / noise[:, None]
    gain = weights * 0.5 * np.log1p(ratio).sum(axis=1)
    height = parameters.evaluation.aim_height - scene.camera_height
    tilt = np.arctan2(height, np.maximum(distance, parameters.evaluation.min_distance))
    return Votes(bearing[near], tilt[near], gain[near])


def pose_information(scene: GazeScene, parameters: NavigationParameters) -> Votes:
    """½ log det(1 + R⁻¹ H P Hᵀ) of every beacon, H of its range and bearing."""
    bearing, distance = scene.beacon_bearing, scene.beacon_distance
    direction = bearing + scene.belief.pose[2]
    c, s = np.cos(direction), np.sin(direction)
    zero = np.zeros_like(c)
    # Both rows in metres: along the line of sight, and across it.
    rows = np.stack(
        [np.stack([-c, -s, zero], axis=1), np.stack([s, -c, -distance], axis=1)], axis=1
    )
    innovation = rows @ scene.belief.pose_covariance @ rows.transpose(0, 2, 1)
    ratio = innovation / sight_sigma(distance, parameters)[:, None, None] ** 2
    gain = 0.5 * np.linalg.slogdet(np.eye(2) + ratio)[1]
    return Votes(bearing, np.zeros(len(bearing)), gain)


def ground_information(scene: GazeScene, parameters: NavigationParameters) -> Votes:
    """Entropy of the presence of a new obstacle at every sample point of the ground."""
    points = points_to_world(scene.belief.pose, scene.samples.points)
    confidence = scene.belief.local_map.confidence_at(points)
    presence = parameters.gaze.information.presence
    probability = np.clip(presence * (1.0 - confidence), 1e-9, 1.0 - 1e-9)
    gain = -probability * np.log(probability)
    gain = gain - (1.0 - probability) * np.log1p(-probability)
    tilt = -np.arctan2(scene.camera_height, scene.samples.distance)
    return Votes(scene.samples.bearing, tilt, gain)


def sight_sigma(distance: Array, parameters: NavigationParameters) -> Array:
    """Return the standard deviation of a position detected at `distance` (n,) [m]."""
    p = parameters.gaze.information
    sigma: Array = p.sight_sigma + p.sight_rate * distance
    return sigma
