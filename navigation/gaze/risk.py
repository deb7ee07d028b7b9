"""Risk gaze: the view that removes the most risk per time.

The four partial evaluations of Yoo & Kim decide on looks: at ground where undetected movers may be
(psi_lm), at obstacles that may have moved (psi_ob), at beacons (psi_sf) and at the ground ahead
(psi_way). Their urgencies feed the gaze map: the value of a view is the sum of the urgencies of
all that its image shows, over the time of the saccade and the look.
"""

from dataclasses import replace
from math import hypot, inf, tan

import numpy as np
from numpy.typing import NDArray

from navigation.belief.belief import Belief, Motion
from navigation.decision import SpeedLimits
from navigation.gaze.gaze_map import GazeGrid
from navigation.gaze.policy import Gaze, GazeContext, GazePolicy
from navigation.gaze.undetected import Undetected
from navigation.gaze.view_kernel import view_values
from navigation.motion.unseen_ground import ground_points
from navigation.observation import CameraView
from navigation.obstacle_set import possible_positions
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import psi_self
from navigation.transform import points_to_robot, velocity_in_world

Array = NDArray[np.float64]

ARRIVED = 0.1  # distance from the chosen gaze at which a fixation begins [rad]
PAN_TOLERANCE = 0.1  # beyond the maximum pan, of a view that a turn moves there [rad]
MAX_AGE = 1e3  # of ground never seen [s]
MAX_HALF_FOV = 1.5  # of a panoramic camera, as a pinhole camera [rad]


class RiskGaze(GazePolicy):
    """Gaze at the view of the highest value per time, decided at every frame.

    Args:
        parameters: of the decisions.
        limits: of the walking layer.
        grid: views.
        beacons: known positions in W (m, 2) [m].
        neck: maximum rate [rad/s] and acceleration [rad/s²] of the camera.
    """

    def __init__(
        self,
        parameters: NavigationParameters,
        limits: SpeedLimits,
        grid: GazeGrid,
        beacons: Array,
        neck: tuple[float, float],
    ) -> None:
        self.steady, self.stabilized = parameters.gaze.moved_by == "body", True
        self._parameters = parameters
        self._speed = limits.vx
        self._grid = grid
        self._beacons = beacons
        self._neck = neck
        self._undetected: Undetected | None = None
        self._beacon_seen = 0.0  # time of the latest beacon [s]
        self._fixated = -inf  # time of the latest frame of a saccade [s]

    def observe(self, belief: Belief) -> None:
        if self._undetected is None:
            parameters = self._parameters.gaze.undetected
            self._undetected = Undetected(parameters, belief.local_map, belief.time)
        self._undetected.update(belief.local_map, belief.time)
        if belief.seen_beacons:
            self._beacon_seen = belief.time

    def look(self, context: GazeContext, now: Gaze) -> tuple[Array, Gaze]:
        p, view = self._parameters.gaze.risk, context.scene.belief.view
        pose = context.scene.belief.pose
        half_fov = (0.5 * view.horizontal_fov, 0.5 * view.vertical_fov)
        lens = np.array([tan(min(half, MAX_HALF_FOV) - p.border) for half in half_fov])
        seen_from = (
            self._looks(context, pose),
            self._discs(context, pose),
            np.array([hypot(*view.position[:2].tolist()), float(view.position[2])]),
            lens,
            np.array([view.pan, view.pan_rate, view.tilt, view.tilt_rate, *self._neck]),
            np.array([p.look_time, p.max_urgency, p.exponent, p.disc_edge]),
            self._turn(context),
        )
        values = view_values(self._grid.pan, self._grid.tilt, *seen_from)
        if self._fixates(context.scene.belief, now):
            return values, now
        present = view_values(np.array([now[0]]), np.array([now[1]]), *seen_from)
        if present[0, 0] * p.switch_ratio >= values.max():
            return values, now
        row, column = np.unravel_index(int(np.argmax(values)), values.shape)
        return values, (float(self._grid.pan[column]), float(self._grid.tilt[row]))

    def _fixates(self, belief: Belief, now: Gaze) -> bool:
        """Return whether the present fixation is younger than a dwell."""
        view = belief.view
        arrived = max(abs(view.pan - now[0]), abs(view.tilt - now[1])) < ARRIVED
        if view.blind or not arrived:
            self._fixated = belief.time
            return False
        return belief.time - self._fixated < self._parameters.gaze.dwell

    def _turn(self, context: GazeContext) -> Array:
        """Return turn rate of the body, 0 without a neck [rad/s], and maximum pan [rad] (2,)."""
        rate = 0.0 if context.motion is None or self.steady else float(context.motion.velocity[2])
        return np.array([rate, self._parameters.gaze.max_pan + PAN_TOLERANCE])

    def _looks(self, context: GazeContext, pose: Array) -> Array:
        """Return all looks, see `view_kernel.view_values` (n, 7)."""
        parts = [
            self._undetected_looks(context, pose),
            self._obstacle_looks(context, pose),
            self._path_looks(context, pose),
            self._beacon_looks(context, pose),
        ]
        return np.concatenate(parts)

    def _undetected_looks(self, context: GazeContext, pose: Array) -> Array:
        """Return the looks at ground where undetected movers may be."""
        assert self._undetected is not None
        belief = context.scene.belief
        motion = context.motion
        twist = np.zeros(3) if motion is None else motion.velocity
        velocity = velocity_in_world(belief.pose, twist)[:2]
        cells = self._undetected.risks(belief.pose[:2], velocity, self._parameters.gaze.risk)
        return _looks(belief.view, points_to_robot(pose, cells[:, :2]), cells[:, 2])

    def _path_looks(self, context: GazeContext, pose: Array) -> Array:
        """Return the looks at the ground ahead: its age over the time until the robot is there."""
        p, belief = self._parameters.gaze.risk, context.scene.belief
        course = float(belief.pose[2]) + context.path
        ahead = ground_points(belief.pose, course, self._parameters.unseen_ground)
        points = points_to_robot(pose, ahead)
        gap = np.hypot(points[:, 0], points[:, 1]) - self._parameters.univector.s_robot
        rate = 1.0 / (p.look_ratio * np.maximum(p.min_time, gap / self._speed))
        age = np.minimum(belief.local_map.age_at(ahead), MAX_AGE) + p.min_age
        looks = _looks(belief.view, points, np.full(len(points), p.path_weight / len(points)))
        looks[:, 3], looks[:, 4] = age * rate, rate
        return looks

    def _beacon_looks(self, context: GazeContext, pose: Array) -> Array:
        """Return the looks at beacons, which must be in view from the foot to the top."""
        p, belief = self._parameters.gaze.risk, context.scene.belief
        evaluation = replace(self._parameters.evaluation, t_heading=p.t_heading)
        psi = psi_self(belief.pose_covariance, evaluation)
        psi = max(psi, min(1.0, (belief.time - self._beacon_seen) / p.beacon_time))
        value = p.beacon_weight * max(0.0, psi - p.min_self_uncertainty)
        points = points_to_robot(pose, self._beacons)
        near = np.hypot(points[:, 0], points[:, 1]) <= self._parameters.evaluation.beacon_range
        reach = self._parameters.gaze.max_pan + 0.5 * belief.view.horizontal_fov
        near &= np.abs(np.arctan2(points[:, 1], points[:, 0])) <= reach
        weights = np.full(int(near.sum()), value / max(1, int(near.sum())))
        looks = _looks(belief.view, points[near], weights)
        looks[:, 5], looks[:, 6] = p.beacon_height, -1.0
        return looks

    def _obstacle_looks(self, context: GazeContext, pose: Array) -> Array:
        """Return the looks at tracks, and at the particles of lost ones.

        The urgency of a look is the age of the track over a fraction of the worst-case time to
        collision.
        """
        p, belief, o = self._parameters.gaze.risk, context.scene.belief, context.scene.obstacles
        if len(o) == 0:
            return np.zeros((0, 7))
        owner, positions, weights = possible_positions(belief.tracks)
        points = points_to_robot(pose, positions)
        distance = np.hypot(points[:, 0], points[:, 1])
        course = context.path + float(belief.pose[2] - pose[2])
        bearing = np.arctan2(points[:, 1], points[:, 0])
        static, moving, radius = o.static[owner], o.moving[owner], o.radius[owner]
        unknown = ~static & ~moving
        hits = np.array([track.hits for track in belief.tracks])[owner]
        worst = np.minimum(p.mover_speed * self._speed, o.speed + 0.5 * o.speed_sigma)[owner]
        approach = np.where(moving, worst, p.unknown_speed * self._speed)
        approach = np.where(static, p.static_speed, approach)
        approach += self._speed * np.maximum(p.min_approach, 0.5 + 0.5 * np.cos(bearing - course))
        gap = distance - radius - self._parameters.univector.s_robot - p.clearance
        rate = 1.0 / (p.look_ratio * np.maximum(p.min_time, gap / approach))
        age = o.age[owner] + p.min_age
        age *= np.where(
            unknown, np.where(hits < p.fresh_hits, p.fresh_factor, p.unknown_factor), 1.0
        )
        weights = weights * np.where(static, p.static_weight, 1.0)
        # The side that faces the robot is seen first.
        points *= np.maximum(0.0, 1.0 - 0.5 * radius / np.maximum(distance, radius))[:, None]
        looks = _looks(belief.view, points, weights)
        looks[:, 3], looks[:, 4] = age * rate, rate
        return looks[distance <= self._parameters.evaluation.attention_range]

    def _discs(self, context: GazeContext, pose: Array) -> Array:
        """Return the obstacles that hide what is behind them: x, y in R, radius (m, 3) [m]."""
        p, belief = self._parameters.gaze.risk, context.scene.belief
        known = [
            (*t.position.tolist(), t.radius)
            for t in belief.tracks
            if t.particles is None and (t.age < p.max_disc_age or t.motion is Motion.STATIC)
        ]
        discs = np.array(known).reshape(-1, 3)
        discs[:, :2] = points_to_robot(pose, discs[:, :2])
        return discs


def _looks(view: CameraView, points: Array, weights: Array) -> Array:
    """Return looks of constant value at obstacles in R, see `view_kernel.view_values` (n, 7).

    A camera that is not above the obstacles sees their feet only.
    """
    looks, sight = np.zeros((len(points), 7)), view.sight
    looks[:, :2], looks[:, 2], looks[:, 3] = points, weights, 1.0
    looks[:, 5] = sight.top if sight.top < view.position[2] else 0.0
    shadow = sight.shadow_at(np.arctan2(points[:, 1], points[:, 0]))
    looks[:, 6] = np.hypot(points[:, 0], points[:, 1]) >= shadow
    return looks
