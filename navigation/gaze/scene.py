"""Scene of one gaze decision: obstacles, beacons and partial evaluations."""

from math import atan2, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.value import value
from navigation.angles import wrap_array
from navigation.belief.belief import Belief
from navigation.belief.tracks import Tracks
from navigation.decision import MotionDecision
from navigation.motion.univector import extended_radius
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import (
    MapEvaluation,
    SamplePoints,
    attended,
    obstacle_free_distance,
    psi_local_map,
    psi_obstacle,
    psi_self,
    psi_way,
)
from navigation.transform import in_robot, points_to_world

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@value
class GazeScene:
    """Scene of one gaze decision.

    Attributes:
        belief: belief of the robot.
        obstacles: all tracks (n).
        bearing: bearings of the obstacles in R (n,) [rad].
        distance: distances of the obstacles (n,) [m].
        attended: the set O (n,).
        reachable: whether each is within pan and half a field of view (n,).
        psi_ob: eq. (3) (n,).
        psi_sf: eq. (2).
        psi_way: eq. (4).
        map: eq. (1).
        samples: its sample points.
        beacon_bearing: bearings of the beacons within reach and range, in R (m,) [rad].
        beacon_distance: distances of these beacons (m,) [m].
        camera_height: above the floor [m].
    """

    belief: Belief
    obstacles: Tracks
    bearing: Array
    distance: Array
    attended: Mask
    reachable: Mask
    psi_ob: Array
    psi_sf: float
    psi_way: float
    map: MapEvaluation
    samples: SamplePoints
    beacon_bearing: Array
    beacon_distance: Array
    camera_height: float

    @property
    def psi_ob_max(self) -> float:
        """Maximum psi_ob over the set O."""
        return float(self.psi_ob[self.attended].max(initial=0.0))

    def aims(self, parameters: NavigationParameters) -> tuple[Mask, Array, Array]:
        """Return the obstacles of O within reach (n,), pan and tilt to each (k,), (k,) [rad]."""
        limit, height = parameters.gaze.max_pan, parameters.evaluation.aim_height
        members = self.attended & self.reachable
        pan = np.clip(self.bearing[members], -limit, limit)
        return members, pan, np.arctan2(height - self.camera_height, self.distance[members])


@compiled
def relative(points: Array, pose: Array) -> tuple[Array, Array]:
    """Return bearing in R (n,) [rad] and distance (n,) [m] of points in W (n, 2) [m]."""
    bearing, distance = np.empty(len(points)), np.empty(len(points))
    for i in range(len(points)):
        x, y = in_robot(pose, points[i, 0], points[i, 1])
        bearing[i], distance[i] = atan2(y, x), sqrt(x * x + y * y)
    return bearing, distance


def gaze_scene(
    belief: Belief,
    motion: MotionDecision | None,
    samples: SamplePoints,
    beacons: Array,
    parameters: NavigationParameters,
) -> GazeScene:
    """Evaluate (1)-(4) in the present belief.

    Args:
        belief: belief of the robot.
        motion: latest decision of the planner, None before the first.
        samples: sample points of (1).
        beacons: known positions of beacons in W (m, 2) [m].
        parameters: parameters of the decisions.
    """
    e, g = parameters.evaluation, parameters.gaze
    view, pose = belief.view, belief.pose
    reach = g.max_pan + 0.5 * view.horizontal_fov
    obstacles = Tracks.of(belief.tracks)
    bearing, distance = relative(np.ascontiguousarray(obstacles.position), pose)
    body = np.zeros(2) if motion is None else motion.velocity[:2]
    velocity = points_to_world(pose, body[None])[0] - pose[:2]
    psi_sf = psi_self(belief.pose_covariance, e)
    psi_ob = psi_obstacle(obstacles, pose[:2], velocity, e)
    members = attended(obstacles.rows, pose, velocity, e.attention_range)
    height = float(view.position[2])
    aside = np.abs(wrap_array(samples.bearing - view.pan))
    above = np.abs(-np.arctan2(height, samples.distance) - view.tilt)
    in_gaze = (aside <= 0.5 * view.horizontal_fov) & (above <= 0.5 * view.vertical_fov)
    in_gaze &= not view.blind
    confidence = belief.local_map.confidence_at(points_to_world(pose, samples.points))
    radii = extended_radius(obstacles, psi_sf, psi_ob, parameters.univector)
    centres, radii = obstacles.position[members], radii[members]
    if motion is not None and motion.virtual_obstacles:
        centres = np.concatenate([centres, [v.position for v in motion.virtual_obstacles]])
        radii = np.concatenate([radii, [v.radius for v in motion.virtual_obstacles]])
    free = obstacle_free_distance(pose[:2], centres, radii, e.d_n_thres)
    beacon_bearing, beacon_distance = relative(beacons, pose)
    near = (beacon_distance <= e.beacon_range) & (np.abs(beacon_bearing) <= reach)
    return GazeScene(
        belief=belief,
        obstacles=obstacles,
        bearing=bearing,
        distance=distance,
        attended=members,
        reachable=np.abs(bearing) <= reach,
        psi_ob=psi_ob,
        psi_sf=psi_sf,
        psi_way=psi_way(free, e),
        map=psi_local_map(confidence, in_gaze, e),
        samples=samples,
        beacon_bearing=beacon_bearing[near],
        beacon_distance=beacon_distance[near],
        camera_height=height,
    )
