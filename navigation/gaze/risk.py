"""Risk gaze: the view that removes the most risk per time.

The four partial evaluations of Yoo & Kim decide on looks: at ground where undetected movers may be
(psi_lm), at obstacles that may have moved (psi_ob), at beacons (psi_sf) and at the ground ahead
(psi_way). Their urgencies feed the gaze map: the value of a view is the sum of the urgencies of
all that its image shows, over the time of the saccade and the look.
"""

from dataclasses import replace
from functools import cache
from math import hypot, inf, tan

import numpy as np
from numpy.typing import NDArray

from compilation.record import record
from compilation.value import value
from navigation.belief.belief import Belief
from navigation.decision import SpeedLimits
from navigation.gaze.grid import GazeGrid
from navigation.gaze.looks import looks_of
from navigation.gaze.policy import Gaze, GazePolicy
from navigation.gaze.scene import GazeScene
from navigation.gaze.undetected import Undetected, risk_limits
from navigation.gaze.views import view_values
from navigation.observation import CameraView
from navigation.parameters.gaze import GroundAheadParameters
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import psi_self
from navigation.transform import SE2, velocity_in_world

Array = NDArray[np.float64]
Rows = NDArray[np.record]

ARRIVED = 0.1  # distance from the chosen gaze at which a fixation begins [rad]
PAN_TOLERANCE = 0.1  # beyond the maximum pan, of a view that a turn moves there [rad]
MAX_HALF_FOV = 1.5  # of a panoramic camera, as a pinhole camera [rad]


@value
class RiskMemory:
    """Memory of the risk gaze.

    Attributes:
        undetected: densities of undetected obstacles; None before the first frame.
        beacon: time of the latest beacon; at first 0, the start of the run [s].
        saccade: time of the latest frame of a saccade [s].
    """

    undetected: Undetected | None = None
    beacon: float = 0.0
    saccade: float = -inf


class RiskGaze(GazePolicy[RiskMemory]):
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
        self._undetected_limits = risk_limits(gaze.undetected, gaze.risk)
        self._limits: tuple[tuple[float, float, float], Rows] | None = None  # of the latest camera

    def begin(self) -> RiskMemory:
        return RiskMemory()

    def observe(self, memory: RiskMemory, belief: Belief) -> RiskMemory:
        undetected, p = memory.undetected, self._parameters.gaze.undetected
        if undetected is None:
            undetected = Undetected.unseen(p, belief.local_map, belief.time)
        return RiskMemory(
            undetected.updated(belief.local_map, belief.time),
            belief.time if belief.seen_beacons else memory.beacon,
            memory.saccade,
        )

    def look(
        self, memory: RiskMemory, scene: GazeScene, now: Gaze
    ) -> tuple[Gaze, Array, RiskMemory]:
        p, belief, view = self._parameters.gaze.risk, scene.belief, scene.belief.view
        half_fov = (0.5 * view.horizontal_fov, 0.5 * view.vertical_fov)
        lens = np.array([tan(min(half, MAX_HALF_FOV) - p.border) for half in half_fov])
        seen_from = (
            self._looks(memory, scene),
            np.array([hypot(*view.position[:2].tolist()), float(view.position[2])]),
            lens,
            np.array([view.pan, view.pan_rate, view.tilt, view.tilt_rate, *self._neck]),
            p.look_time,
            p.max_urgency,
            self._turn(scene),
        )
        values = view_values(self._grid.pan, self._grid.tilt, *seen_from)
        arrived = max(abs(view.pan - now[0]), abs(view.tilt - now[1])) < ARRIVED
        if view.blind or not arrived:
            memory = replace(memory, saccade=belief.time)
        elif belief.time - memory.saccade < self._parameters.gaze.dwell:
            return now, values, memory
        present = view_values(np.array([now[0]]), np.array([now[1]]), *seen_from)
        if present[0, 0] * p.switch_ratio >= values.max():
            return now, values, memory
        row, column = np.unravel_index(int(np.argmax(values)), values.shape)
        return (float(self._grid.pan[column]), float(self._grid.tilt[row])), values, memory

    def _turn(self, scene: GazeScene) -> Array:
        """Return turn rate of the body, 0 without a neck [rad/s], and maximum pan [rad] (2,)."""
        rate = 0.0 if scene.motion is None or self.steady else float(scene.motion.velocity[2])
        return np.array([rate, self._parameters.gaze.max_pan + PAN_TOLERANCE])

    def _looks(self, memory: RiskMemory, scene: GazeScene) -> Rows:
        """Return all looks, records of type `Look`."""
        assert memory.undetected is not None
        belief, tracks, course = scene.belief, scene.obstacles, scene.course
        pose = belief.pose
        twist = np.zeros(3) if scene.motion is None else scene.motion.velocity
        velocity = velocity_in_world(pose, twist)
        ground = ground_points(pose, float(pose[2]) + course, self._parameters.gaze.ground)
        return looks_of(
            tracks.rows,
            tracks.clouds,
            memory.undetected.risks(pose[:2], velocity, self._undetected_limits),
            (ground, belief.local_map.age_at(ground)),
            (self._beacons, self._beacon_weight(memory, belief)),
            (pose, course),
            belief.view.model.shadow,
            self._limits_of(belief.view),
        )

    def _beacon_weight(self, memory: RiskMemory, belief: Belief) -> float:
        """Return the weight of all beacons together [1]."""
        p = self._parameters.gaze.risk
        psi = psi_self(belief.pose_covariance, self._evaluation)
        psi = max(psi, min(1.0, (belief.time - memory.beacon) / p.beacon_time))
        return p.beacon_weight * max(0.0, psi - p.min_self_uncertainty)

    def _limits_of(self, view: CameraView) -> Rows:
        """Return the parameters of the looks for a camera, kept until the camera changes."""
        top = view.model.top if view.model.top < view.position[2] else 0.0
        reach = self._parameters.gaze.max_pan + 0.5 * view.horizontal_fov
        camera = (top, view.model.seam, reach)
        if self._limits is None or self._limits[0] != camera:
            numbers = dict(zip(("obstacle_height", "seam", "reach"), camera, strict=True))
            self._limits = camera, record(self._parameters.gaze.risk, **self._numbers, **numbers)
        return self._limits[1]


def ground_points(pose: Array, direction: float, parameters: GroundAheadParameters) -> Array:
    """Return the checked points in W, three columns ahead of the robot (3 rows, 2) [m].

    Args:
        pose: pose of the robot (3,) [m, m, rad].
        direction: direction of its motion in W [rad].
        parameters: extent of the ground.
    """
    p = parameters
    along, across = _ground(p.near, p.far, p.half_width, p.rows)
    x, y, _ = pose.tolist()
    return np.stack(SE2(x, y, direction) @ (along, across), axis=1)


@cache
def _ground(near: float, far: float, half_width: float, rows: int) -> tuple[Array, Array]:
    """Return coordinates along and across the motion (3 rows,), (3 rows,) [m]."""
    along, across = np.meshgrid(np.linspace(near, far, rows), (-half_width, 0.0, half_width))
    return along.ravel(), across.ravel()
