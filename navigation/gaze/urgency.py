"""Urgency votes: age of the knowledge of an obstacle over the time within which it can be met.

The other three evaluations stay those of Yoo & Kim, section II; ground that the gate waits
for votes too. It is kept as the step between (1)-(6) and the deadline votes.
"""

import numpy as np
from numpy.typing import NDArray

from navigation.belief.belief import Belief
from navigation.decision import Task
from navigation.gaze.gaze_map import Votes
from navigation.gaze.integrated import map_votes, self_votes, waypoint_vote
from navigation.gaze.scene import GazeScene
from navigation.gaze.unseen_ground_vote import unseen_ground_vote
from navigation.parameters.navigation import NavigationParameters

Array = NDArray[np.float64]


def urgency_votes(
    scene: GazeScene,
    belief: Belief,
    task: Task,
    *,
    way: float,
    speed: float,
    parameters: NavigationParameters,
) -> Votes:
    """All votes of this moment.

    Args:
        scene: partial evaluations.
        belief: what the robot believes.
        task: the way point.
        way: bearing of the planned velocity in R [rad].
        speed: the robot's largest speed [m/s].
        parameters: of the decisions.
    """
    p = parameters.gaze
    seen, pan, tilt = scene.aims(parameters)
    votes = map_votes(scene, p.w_lm, p.map_votes)
    votes.append(waypoint_vote(scene, belief, task, p.w_way, parameters))
    votes.append(Votes(pan, tilt, p.w_ob * obstacle_urgency(scene, way, speed, parameters)[seen]))
    votes += self_votes(scene, pan, tilt, p)
    votes += unseen_ground_vote(
        belief, way, scene.camera_height, p.urgency.unseen_ground_weight, parameters
    )
    return Votes.join(votes)


def obstacle_urgency(
    scene: GazeScene, way: float, speed: float, parameters: NavigationParameters
) -> Array:
    """Urgency of a look at every obstacle (n,) [1]; arguments as for `urgency_votes`."""
    u, o = parameters.gaze.urgency, scene.obstacles
    unknown = ~o.static & ~o.moving
    gap = scene.distance - o.radius - parameters.univector.s_robot
    contact = np.maximum(u.min_time, gap / (speed + o.speed))
    age = o.age + np.where(unknown, u.unknown_bonus, u.bonus)
    ahead = u.side_weight + (1.0 - u.side_weight) * np.maximum(0.0, np.cos(scene.bearing - way))
    weight = np.where(o.static, u.static_weight, 1.0)
    value: Array = np.minimum(u.max_urgency, age / contact) * ahead * weight
    return value
