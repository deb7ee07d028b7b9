"""Scene of one gaze decision: scene of the frame, directions, and equations (1) and (4)."""

from math import atan2, hypot, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.value import value
from navigation.angles import wrap, wrap_array
from navigation.belief.belief import Belief
from navigation.belief.tracks import Tracks
from navigation.decision import MotionDecision, Task
from navigation.observation import CameraView
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import (
    MapEvaluation,
    SamplePoints,
    attended,
    obstacle_free_distance,
    psi_local_map,
    psi_way,
)
from navigation.scene import Scene
from navigation.transform import in_robot, points_to_world

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@value
class GazeScene:
    """Scene of one gaze decision.

    Its obstacles are the tracks of the belief, without the landmarks of the scene.

    Attributes:
        scene: scene of the frame.
        motion: decision of the motion planner; None before the first.
        obstacles: all tracks (n).
        bearing: bearings of the obstacles in R (n,) [rad].
        distance: distances of the obstacles (n,) [m].
        attended: the set O (n,).
        reachable: whether each is within pan and half a field of view (n,).
        psi_ob: eq. (3) (n,).
        psi_way: eq. (4).
        map: eq. (1).
        samples: its sample points.
        beacon_bearing: bearings of the beacons within reach and range, in R (m,) [rad].
        camera_height: above the floor [m].
    """

    scene: Scene
    motion: MotionDecision | None
    obstacles: Tracks
    bearing: Array
    distance: Array
    attended: Mask
    reachable: Mask
    psi_ob: Array
    psi_way: float
    map: MapEvaluation
    samples: SamplePoints
    beacon_bearing: Array
    camera_height: float

    @classmethod
    def of(
        cls,
        scene: Scene,
        motion: MotionDecision | None,
        samples: SamplePoints,
        beacons: Array,
        parameters: NavigationParameters,
    ) -> "GazeScene":
        """Evaluate (1) and (4), and the directions of obstacles and beacons.

        Args:
            scene: scene of the frame.
            motion: decision of the motion planner; None before the first.
            samples: sample points of (1).
            beacons: known positions of beacons in W (m, 2) [m].
            parameters: parameters of the decisions.
        """
        e, belief, tracks = parameters.evaluation, scene.belief, slice(scene.landmarks, None)
        view, pose, obstacles = belief.view, belief.pose, scene.obstacles[tracks]
        reach = parameters.gaze.max_pan + 0.5 * view.horizontal_fov
        bearing, distance = relative(np.ascontiguousarray(obstacles.position), pose)
        members = attended(obstacles.rows, pose, scene.velocity, e.attention_range)
        beacon_bearing, beacon_distance = relative(beacons, pose)
        near = (beacon_distance <= e.beacon_range) & (np.abs(beacon_bearing) <= reach)
        confidence = belief.local_map.confidence_at(points_to_world(pose, samples.points))
        centres, radii = obstacles.position[members], scene.s_oe[tracks][members]
        if motion is not None and motion.virtual_obstacles:
            centres = np.concatenate([centres, [v.position for v in motion.virtual_obstacles]])
            radii = np.concatenate([radii, [v.radius for v in motion.virtual_obstacles]])
        free = obstacle_free_distance(pose[:2], centres, radii, e.d_n_thres)
        return cls(
            scene=scene,
            motion=motion,
            obstacles=obstacles,
            bearing=bearing,
            distance=distance,
            attended=members,
            reachable=np.abs(bearing) <= reach,
            psi_ob=scene.psi_ob[tracks],
            psi_way=psi_way(free, e),
            map=psi_local_map(confidence, shown_by(view, samples), e),
            samples=samples,
            beacon_bearing=beacon_bearing[near],
            camera_height=float(view.position[2]),
        )

    @property
    def belief(self) -> Belief:
        """Belief of the robot."""
        return self.scene.belief

    @property
    def task(self) -> Task:
        """Task of the mission."""
        return self.scene.task

    @property
    def psi_sf(self) -> float:
        """Eq. (2)."""
        return self.scene.psi_sf

    @property
    def psi_ob_max(self) -> float:
        """Maximum psi_ob over the set O."""
        return float(self.psi_ob[self.attended].max(initial=0.0))

    @property
    def course(self) -> float:
        """Bearing of the planned velocity in R, of the destination if that is zero [rad]."""
        if self.motion is not None:
            vx, vy, _ = self.motion.velocity.tolist()
            if hypot(vx, vy) > 1e-3:
                return atan2(vy, vx)
        pose = self.belief.pose
        dx, dy = (self.task.target - pose[:2]).tolist()
        return wrap(atan2(dy, dx) - float(pose[2]))


@compiled
def relative(points: Array, pose: Array) -> tuple[Array, Array]:
    """Return bearing in R (n,) [rad] and distance (n,) [m] of points in W (n, 2) [m]."""
    bearing, distance = np.empty(len(points)), np.empty(len(points))
    for i in range(len(points)):
        x, y = in_robot(pose, points[i, 0], points[i, 1])
        bearing[i], distance[i] = atan2(y, x), sqrt(x * x + y * y)
    return bearing, distance


def shown_by(view: CameraView, samples: SamplePoints) -> Mask:
    """Return which sample points lie in the gaze region R_g of eq. (1); none in a blind frame."""
    aside = np.abs(wrap_array(samples.bearing - view.pan))
    above = np.abs(-np.arctan2(float(view.position[2]), samples.distance) - view.tilt)
    inside: Mask = (aside <= 0.5 * view.horizontal_fov) & (above <= 0.5 * view.vertical_fov)
    return inside & (not view.blind)
