"""Deadline votes: the urgency of a look is the age of a track over its time to collision.

A look is overdue once the robot could have collided with the object since last seeing it. The
structure is that of Yoo & Kim: four evaluations, a gaze map, its highest centre. A lost mover
votes at the positions of its particles.
"""

from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap, wrap_array
from navigation.belief.belief import Belief, Motion
from navigation.gaze.gaze_map import Votes
from navigation.gaze.integrated import beacon_votes
from navigation.gaze.scene import GazeScene, relative
from navigation.gaze.unseen_ground_vote import unseen_ground_vote
from navigation.parameters.gaze import GazeParameters
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints, psi_self
from navigation.transform import points_to_world

Array = NDArray[np.float64]


def deadline_votes(
    scene: GazeScene,
    path: float,
    speed: float,
    parameters: NavigationParameters,
    *,
    look_request: float | None = None,
    turn_rate: float = 0.0,
) -> Votes:
    """Return all deadline votes.

    Tracks, ground and the look request vote where they will be after the saccade, beacons where
    they are now, even beyond the pan limit.

    Args:
        scene: partial evaluations.
        path: bearing of the planned velocity in R [rad].
        speed: maximum speed of the robot [m/s].
        parameters: of the decisions.
        look_request: direction in W that the rear check turns to; None for none [rad].
        turn_rate: of the body [rad/s].
    """
    p = parameters.gaze
    x, y, heading = scene.belief.pose.tolist()
    predicted = np.array([x, y, heading + p.deadline.saccade_time * turn_rate])
    scene = replace(scene, belief=replace(scene.belief, pose=predicted))
    votes = [
        obstacle_deadlines(scene, path, speed, parameters),
        map_deadlines(scene, path, speed, parameters),
        Votes.one(
            min(max(path, -p.max_pan), p.max_pan),
            float(-np.arctan2(scene.camera_height, p.deadline.path_distance)),
            p.deadline.path_weight,
        ),
        beacon_votes(scene, p.deadline.beacon_weight * self_urgency(scene.belief, parameters)),
    ]
    if look_request is not None:
        votes += look_request_vote(scene.belief, look_request, p)
    votes += unseen_ground_vote(scene, path, p.deadline.unseen_ground_weight, parameters)
    return Votes.join(votes)


def look_request_vote(
    belief: Belief, look_request: float, parameters: GazeParameters
) -> list[Votes]:
    """Return the vote for the ground in direction `look_request` in W [rad], if within reach."""
    p = parameters
    bearing = wrap(look_request - float(belief.pose[2]))
    if abs(bearing) > p.max_pan + p.box_fraction * belief.view.horizontal_fov:
        return []
    pan = min(max(bearing, -p.max_pan), p.max_pan)
    return [Votes.one(pan, p.deadline.look_request_tilt, p.deadline.look_request_weight)]


def self_urgency(belief: Belief, parameters: NavigationParameters) -> float:
    """Return psi_sf of eq. (2) with the heading threshold of the deadlines, in [0, 1]."""
    t_heading = parameters.gaze.deadline.t_heading
    return psi_self(belief.pose_covariance, replace(parameters.evaluation, t_heading=t_heading))


def obstacle_deadlines(
    scene: GazeScene, path: float, speed: float, parameters: NavigationParameters
) -> Votes:
    """Return the votes of tracks and of the particles of lost ones (see `deadline_votes`)."""
    p, d, belief, o = parameters.gaze, parameters.gaze.deadline, scene.belief, scene.obstacles
    lost = np.array([t.particles is not None for t in belief.tracks], dtype=np.bool_)
    owners = [np.nonzero(~lost)[0]]
    positions = [o.position[~lost]]
    weights = [np.ones(int((~lost).sum()))]
    for k, track in enumerate(belief.tracks):
        if track.particles is not None:
            owners.append(np.full(len(track.particles.weights), k))
            positions.append(track.particles.positions)
            weights.append(track.particles.weights)
    index = np.concatenate(owners).astype(np.int64)
    bearing, distance = relative(np.concatenate(positions), belief.pose)
    weight = np.concatenate(weights)
    reach = p.max_pan + p.box_fraction * belief.view.horizontal_fov - 0.05
    # Undecided tracks of few detections: one more look may decide them.
    fresh = np.array(
        [t.motion is Motion.UNKNOWN and t.hits < d.fresh_hits for t in belief.tracks],
        dtype=np.bool_,
    )[index]
    near = fresh | (distance <= parameters.evaluation.attention_range)
    in_reach = near & (np.abs(bearing) <= reach)
    fresh, index, weight = fresh[in_reach], index[in_reach], weight[in_reach]
    bearing, distance = bearing[in_reach], distance[in_reach]
    static, moving = o.static[index], o.moving[index]
    unknown = ~static & ~moving
    assumed_speed = np.where(
        static,
        d.static_speed,
        np.where(
            moving,
            np.minimum(d.mover_speed * speed, o.speed[index] + 0.5 * o.speed_sigma[index]),
            d.unknown_speed * speed,
        ),
    )
    closing = assumed_speed + speed * np.maximum(0.25, 0.5 + 0.5 * np.cos(bearing - path))
    gap = distance - o.radius[index] - parameters.univector.s_robot - d.clearance
    time = np.maximum(d.min_time, gap / closing)
    age = o.age[index] + d.min_age + d.unknown_bonus * unknown + d.fresh_bonus * fresh
    urgency = np.minimum(d.max_urgency, age / (d.look_ratio * time)) ** d.exponent
    value = weight * urgency * np.where(static, d.static_weight, 1.0)
    tilt = np.arctan2(
        parameters.evaluation.aim_height - scene.camera_height, np.maximum(distance, 0.05)
    )
    return Votes(bearing, tilt, value)


def map_deadlines(
    scene: GazeScene, path: float, speed: float, parameters: NavigationParameters
) -> Votes:
    """Return the votes of ground by the time since it was seen (see `deadline_votes`)."""
    p, d, belief = parameters.gaze, parameters.gaze.deadline, scene.belief
    reach = p.max_pan + p.box_fraction * belief.view.horizontal_fov
    ground = _ground(reach, d.map_rings, d.map_rays)
    distance, bearing = ground.distance, ground.bearing
    points = points_to_world(belief.pose, ground.points)
    age = np.minimum(d.max_age, belief.local_map.age_at(points))
    closing = speed * (d.map_speed + np.maximum(0.1, np.cos(bearing - path)))
    gap = distance - 2.0 * parameters.univector.s_robot
    time = np.maximum(d.min_time, gap / closing)
    value = d.map_weight * np.minimum(d.max_urgency, age / time) ** d.exponent
    tilt = -np.arctan2(scene.camera_height, distance)
    return Votes(wrap_array(bearing), tilt, value)


@cache
def _ground(reach: float, rings: tuple[float, ...], rays: int) -> SamplePoints:
    """Sample points of the ground that votes, up to the bearing `reach` [rad]."""
    return SamplePoints.of(np.array(rings), np.linspace(-reach, reach, rays))
