"""The vote for the ground that the confidence gate waits for."""

import numpy as np

from navigation.belief.belief import Belief
from navigation.gaze.gaze_map import Votes
from navigation.motion.unseen_ground import ground_seen
from navigation.parameters.navigation import NavigationParameters


def unseen_ground_vote(
    belief: Belief, way: float, height: float, weight: float, parameters: NavigationParameters
) -> list[Votes]:
    """A vote for the ground that holds the robot up; none where the gate is off or lets it pass.

    Args:
        belief: what the robot believes.
        way: bearing of the planned velocity in R [rad].
        height: of the camera above the floor [m].
        weight: of the vote.
        parameters: of the decisions.
    """
    g, p = parameters.unseen_ground, parameters.gaze
    if not g.enabled or ground_seen(belief, float(belief.pose[2]) + way, g):
        return []
    pan = min(max(way, -p.max_pan), p.max_pan)
    tilt = -float(np.arctan2(height, 0.5 * (g.near + g.far)))
    return [Votes.one(pan, tilt, weight)]
