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

from compilation.record import record
from navigation.belief.belief import Belief
from navigation.belief.tracks import Tracks
from navigation.decision import SpeedLimits
from navigation.gaze.gaze_map import GazeGrid
from navigation.gaze.looks import looks_of
from navigation.gaze.policy import Gaze, GazeContext, GazePolicy
from navigation.gaze.undetected import Undetected
from navigation.gaze.views import view_values
from navigation.motion.unseen_ground import ground_points
from navigation.observation import CameraView
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import psi_self
from navigation.transform import velocity_in_world

Array = NDArray[np.float64]

ARRIVED = 0.1  # distance from the chosen gaze at which a fixation begins [rad]
PAN_TOLERANCE = 0.1  # beyond the maximum pan, of a view that a turn moves there [rad]
MAX_HALF_FOV = 1.5  # of a panoramic camera, as a pinhole camera [rad]


class RiskGaze(GazePolicy):
    """Gaze at the view of the highest value per time, decided at every frame.

    Args:
        parameters: parameters of the decisions.
        limits: speed limits of the walking layer.
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
        gaze, evaluation = parameters.gaze, parameters.evaluation
        self.steady, self.stabilized = gaze.moved_by == "body", True
        self._parameters = parameters
        self._grid = grid
        self._beacons = beacons
        self._neck = neck
        self._evaluation = replace(evaluation, t_heading=gaze.risk.t_heading)
        self._numbers = {
            "speed": limits.vx,
            "s_robot": parameters.univector.s_robot,
            "attention_range": evaluation.attention_range,
            "beacon_range": evaluation.beacon_range,
        }
        self._limits: tuple[tuple[float, float], NDArray[np.record]] | None = None
        self._undetected: Undetected | None = None
        self._beacon_seen = 0.0  # time of the latest beacon [s]
        self._fixated = -inf  # time of the latest frame of a saccade [s]

    def observe(self, belief: Belief) -> None:
        if self._undetected is None:
            gaze = self._parameters.gaze
            self._undetected = Undetected(gaze.undetected, gaze.risk, belief.local_map, belief.time)
        self._undetected.update(belief.local_map, belief.time)
        if belief.seen_beacons:
            self._beacon_seen = belief.time

    def look(self, context: GazeContext, now: Gaze) -> tuple[Array, Gaze]:
        p, view = self._parameters.gaze.risk, context.scene.belief.view
        half_fov = (0.5 * view.horizontal_fov, 0.5 * view.vertical_fov)
        lens = np.array([tan(min(half, MAX_HALF_FOV) - p.border) for half in half_fov])
        seen_from = (
            self._looks(context),
            np.array([hypot(*view.position[:2].tolist()), float(view.position[2])]),
            lens,
            np.array([view.pan, view.pan_rate, view.tilt, view.tilt_rate, *self._neck]),
            p.look_time,
            p.max_urgency,
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

    def _looks(self, context: GazeContext) -> NDArray[np.record]:
        """Return all looks, records of type `LOOK`."""
        assert self._undetected is not None
        belief, motion = context.scene.belief, context.motion
        pose, tracks = belief.pose, Tracks.of(belief.tracks)
        twist = np.zeros(3) if motion is None else motion.velocity
        velocity = velocity_in_world(pose, twist)[:2]
        course = context.path
        ground = ground_points(pose, float(pose[2]) + course, self._parameters.unseen_ground)
        return looks_of(
            tracks.rows,
            tracks.clouds,
            self._undetected.risks(pose[:2], velocity),
            (ground, belief.local_map.age_at(ground)),
            (self._beacons, self._beacon_weight(belief)),
            (pose, course),
            belief.view.model.shadow,
            self._limits_of(belief.view),
        )

    def _beacon_weight(self, belief: Belief) -> float:
        """Return the weight of all beacons together [1]."""
        p = self._parameters.gaze.risk
        psi = psi_self(belief.pose_covariance, self._evaluation)
        psi = max(psi, min(1.0, (belief.time - self._beacon_seen) / p.beacon_time))
        return p.beacon_weight * max(0.0, psi - p.min_self_uncertainty)

    def _limits_of(self, view: CameraView) -> NDArray[np.record]:
        """Return the parameters of the looks for a camera, kept until the camera changes."""
        top = view.model.top if view.model.top < view.position[2] else 0.0
        camera = (top, self._parameters.gaze.max_pan + 0.5 * view.horizontal_fov)
        if self._limits is None or self._limits[0] != camera:
            numbers = self._numbers | {"obstacle_height": top, "reach": camera[1]}
            self._limits = camera, record(self._parameters.gaze.risk, **numbers)
        return self._limits[1]
