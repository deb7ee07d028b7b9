"""Urgency votes: age of the knowledge of an obstacle over its time to collision.

The other three evaluations are those of Yoo & Kim, section II; unseen ground that slows the robot
down votes too. This gaze is the step between (1)-(6) and the deadline votes.
"""

import numpy as np
from numpy.typing import NDArray

from navigation.decision import Task
from navigation.gaze.gaze_map import Votes
from navigation.gaze.integrated import map_votes, self_votes, waypoint_vote
from navigation.gaze.scene import GazeScene
from navigation.gaze.unseen_ground_vote import unseen_ground_vote
from navigation.parameters.navigation import NavigationParameters

Array = NDArray[np.float64]


def urgency_votes(
    scene: GazeScene, task: Task, path: float, speed: float, parameters: NavigationParameters
) -> Votes:
    """Return all urgency votes.

    Args:
        scene: partial evaluations.
        task: waypoint.
        path: bearing of the planned velocity in R [rad].
        speed: maximum speed of the robot [m/s].
        parameters: of the decisions.
    """
    p = parameters.gaze
    members, pan, tilt = scene.aims(parameters)
    urgency = obstacle_urgency(scene, path, speed, parameters)[members]
    votes = map_votes(scene, p.w_lm, p.map_votes)
    votes.append(waypoint_vote(scene, task, p.w_way, parameters))
    votes.append(Votes(pan, tilt, p.w_ob * urgency))
    votes += self_votes(scene, pan, tilt, p)
    votes += unseen_ground_vote(scene, path, p.urgency.unseen_ground_weight, parameters)
    return Votes.join(votes)


def obstacle_urgency(
    scene: GazeScene, path: float, speed: float, parameters: NavigationParameters
) -> Array:
    """Return the urgency of a look at every obstacle (n,) [1] (see `urgency_votes`)."""
    u, o = parameters.gaze.urgency, scene.obstacles
    unknown = ~o.static & ~o.moving
    gap = scene.distance - o.radius - parameters.univector.s_robot
    time = np.maximum(u.min_time, gap / (speed + o.speed))
    age = o.age + np.where(unknown, u.unknown_bonus, u.bonus)
    ahead = u.side_weight + (1.0 - u.side_weight) * np.maximum(0.0, np.cos(scene.bearing - path))
    weight = np.where(o.static, u.static_weight, 1.0)
    value: Array = np.minimum(u.max_urgency, age / time) * ahead * weight
    return value
