"""Vote for unseen ground that slows the robot down."""

import numpy as np

from navigation.gaze.gaze_map import Votes
from navigation.gaze.scene import GazeScene
from navigation.motion.unseen_ground import ground_seen
from navigation.parameters.navigation import NavigationParameters


def unseen_ground_vote(
    scene: GazeScene, path: float, weight: float, parameters: NavigationParameters
) -> list[Votes]:
    """Return a vote for the ground ahead if it is unseen and the planner slows down for it.

    Args:
        scene: partial evaluations.
        path: bearing of the planned velocity in R [rad].
        weight: of the vote.
        parameters: of the decisions.
    """
    g, p, belief = parameters.unseen_ground, parameters.gaze, scene.belief
    if not g.enabled or ground_seen(belief, float(belief.pose[2]) + path, g):
        return []
    pan = min(max(path, -p.max_pan), p.max_pan)
    tilt = -float(np.arctan2(scene.camera_height, 0.5 * (g.near + g.far)))
    return [Votes.one(pan, tilt, weight)]
