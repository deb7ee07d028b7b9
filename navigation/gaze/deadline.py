"""Deadline votes: how late a look is, measured by a share of the worst-case time to contact.

The structure is the paper's: four evaluations, a gaze map, its highest centre. What fills
the obstacle and map evaluations is the age of the knowledge over the time within which it
must be renewed, and a lost mover votes wherever it may be.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap, wrap_array
from navigation.belief.belief import Belief, Motion, Track
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
    belief: Belief,
    way: float,
    speed: float,
    parameters: NavigationParameters,
    *,
    look_request: float | None = None,
    turn: float = 0.0,
) -> Votes:
    """All deadline votes of this moment.

    Tracks, ground and look request vote where they will be after the saccade, beacons where they
    are now, also beyond the pan stop.

    Args:
        scene: partial evaluations.
        belief: what the robot believes.
        way: bearing of the planned velocity in R [rad].
        speed: the robot's largest speed [m/s].
        parameters: of the decisions.
        look_request: direction in W of ground that the body turned aside for; None for none [rad].
        turn: rate of the body [rad/s].
    """
    p = parameters.gaze
    x, y, heading = belief.pose.tolist()
    belief = replace(belief, pose=np.array([x, y, heading + p.deadline.saccade_time * turn]))
    height = scene.camera_height
    votes = [
        obstacle_deadlines(scene, belief, way, speed, parameters),
        map_deadlines(scene, belief, way, speed, parameters),
        Votes.one(
            min(max(way, -p.max_pan), p.max_pan),
            float(-np.arctan2(height, p.deadline.path_distance)),
            p.deadline.path_weight,
        ),
        beacon_votes(scene, p.deadline.beacon_weight * self_urgency(belief, parameters)),
    ]
    if look_request is not None:
        votes += look_request_vote(belief, look_request, p)
    votes += unseen_ground_vote(belief, way, height, p.deadline.unseen_ground_weight, parameters)
    return Votes.join(votes)


def look_request_vote(
    belief: Belief, look_request: float, parameters: GazeParameters
) -> list[Votes]:
    """The ground at `look_request` in W [rad], once the gaze reaches it."""
    p = parameters
    bearing = wrap(look_request - float(belief.pose[2]))
    if abs(bearing) > p.max_pan + p.box_fraction * belief.view.horizontal_fov:
        return []
    pan = min(max(bearing, -p.max_pan), p.max_pan)
    return [Votes.one(pan, p.deadline.look_request_tilt, p.deadline.look_request_weight)]


def self_urgency(belief: Belief, parameters: NavigationParameters) -> float:
    """psi_sf of eq. (2) with the heading tolerance of the deadlines, in [0, 1]."""
    t_heading = parameters.gaze.deadline.t_heading
    return psi_self(belief.pose_covariance, replace(parameters.evaluation, t_heading=t_heading))


def obstacle_deadlines(
    scene: GazeScene,
    belief: Belief,
    way: float,
    speed: float,
    parameters: NavigationParameters,
) -> Votes:
    """Votes of tracks and of the particles of lost ones; arguments as `deadline_votes`."""
    p, d = parameters.gaze, parameters.gaze.deadline
    o = scene.obstacles
    lost = np.array([t.particles is not None for t in belief.tracks], dtype=np.bool_)
    owner = [np.nonzero(~lost)[0]]
    place = [o.position[~lost]]
    share = [np.ones(int((~lost).sum()))]
    for index, track in enumerate(belief.tracks):
        if track.particles is not None:
            owner.append(np.full(len(track.particles.weights), index))
            place.append(track.particles.positions)
            share.append(track.particles.weights)
    index_ = np.concatenate(owner).astype(np.int64)
    bearing, distance = relative(np.concatenate(place), belief.pose)
    weight = np.concatenate(share)
    reach = p.max_pan + p.box_fraction * belief.view.horizontal_fov - 0.05
    fresh = _fresh(belief.tracks, d.fresh_hits)[index_]
    near = fresh | (distance <= parameters.evaluation.attention_range)
    in_reach = near & (np.abs(bearing) <= reach)
    fresh, index_, weight = fresh[in_reach], index_[in_reach], weight[in_reach]
    bearing, distance = bearing[in_reach], distance[in_reach]
    static, moving = o.static[index_], o.moving[index_]
    unknown = ~static & ~moving
    feared = np.where(
        static,
        d.static_speed,
        np.where(
            moving,
            np.minimum(d.mover_speed * speed, o.speed[index_] + 0.5 * o.speed_sigma[index_]),
            d.unknown_speed * speed,
        ),
    )
    approach = feared + speed * np.maximum(0.25, 0.5 + 0.5 * np.cos(bearing - way))
    gap = distance - o.radius[index_] - parameters.univector.s_robot - d.clearance
    contact = np.maximum(d.min_time, gap / approach)
    age = o.age[index_] + d.min_age + d.unknown_bonus * unknown + d.fresh_bonus * fresh
    urgency = np.minimum(d.max_urgency, age / (d.look_ratio * contact)) ** d.exponent
    value = weight * urgency * np.where(static, d.static_weight, 1.0)
    tilt = np.arctan2(
        parameters.evaluation.aim_height - scene.camera_height, np.maximum(distance, 0.05)
    )
    return Votes(bearing, tilt, value)


def _fresh(tracks: Sequence[Track], hits: int) -> NDArray[np.bool_]:
    """Undecided tracks of fewer detections than `hits` (n,): one more look may decide them."""
    return np.array([t.motion is Motion.UNKNOWN and t.hits < hits for t in tracks], dtype=np.bool_)


def map_deadlines(
    scene: GazeScene,
    belief: Belief,
    way: float,
    speed: float,
    parameters: NavigationParameters,
) -> Votes:
    """Votes of ground not seen for long; arguments as `deadline_votes`."""
    p, d = parameters.gaze, parameters.gaze.deadline
    reach = p.max_pan + p.box_fraction * belief.view.horizontal_fov
    ground = _ground(reach, d.map_rings, d.map_rays)
    distance, bearing = ground.distance, ground.bearing
    age = np.minimum(
        d.max_age, belief.local_map.age_at(points_to_world(belief.pose, ground.points))
    )
    approach = speed * (d.map_speed + np.maximum(0.1, np.cos(bearing - way)))
    room = distance - 2.0 * parameters.univector.s_robot
    contact = np.maximum(d.min_time, room / approach)
    value = d.map_weight * np.minimum(d.max_urgency, age / contact) ** d.exponent
    tilt = -np.arctan2(scene.camera_height, distance)
    return Votes(wrap_array(bearing), tilt, value)


@cache
def _ground(reach: float, rings: tuple[float, ...], rays: int) -> SamplePoints:
    """The ground that votes, as far round as the gaze sees, `reach` [rad]."""
    return SamplePoints.of(np.array(rings), np.linspace(-reach, reach, rays))
