"""Where to look: the highest centre of the gaze map, decided again after every saccade."""

from collections.abc import Mapping
from math import atan2, hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief import Belief
from navigation.deadline_gaze import deadline_votes
from navigation.decision import GazeDecision, MotionDecision, SpeedLimits, Task
from navigation.decision_parameters import NavigationParameters
from navigation.gaze_map import GazeGrid, Votes
from navigation.gaze_scene import GazeScene, gaze_scene
from navigation.gaze_timing import GazeTiming
from navigation.integrated_gaze import integrated_votes
from navigation.partial_evaluation import SamplePoints

Array = NDArray[np.float64]


class GazePlanner:
    """Gaze control of Yoo & Kim, section II, and its comparisons."""

    def __init__(
        self,
        parameters: NavigationParameters,
        limits: SpeedLimits,
        beacons: Mapping[str, tuple[float, float]],
        horizontal_fov: float,
        vertical_fov: float,
    ) -> None:
        """Start with the gaze ahead.

        Args:
            parameters: profile.
            limits: envelope of the walking layer.
            beacons: places in W by name [m].
            horizontal_fov: of the camera [rad].
            vertical_fov: of the camera [rad].
        """
        p = parameters.gaze
        self._parameters = parameters
        self._limits = limits
        self._beacons = np.array([beacons[name] for name in sorted(beacons)]).reshape(-1, 2)
        self._samples = SamplePoints.polar(parameters.evaluation, p.pan_limit)
        self._grid = GazeGrid(
            pan_limit=p.pan_limit,
            tilt_min=p.tilt_min,
            tilt_max=p.tilt_max,
            step=p.step,
            half_pan=p.box_share * horizontal_fov,
            half_tilt=p.box_share * vertical_fov,
        )
        self._timing = GazeTiming(p.dwell, p.arrival_tolerance, p.saccade_limit)
        self._pan, self._tilt = 0.0, p.fixed_tilt
        self._last: GazeDecision | None = None

    def choose(self, belief: Belief, task: Task, motion: MotionDecision | None) -> GazeDecision:
        """Choose the gaze; call at every frame or every 0.1 s.

        Args:
            belief: what the robot believes.
            task: where it goes.
            motion: how it moves, None before the first plan.

        Returns:
            The decision in force, a new one once the head has arrived and rested.
        """
        due = self._sweeping(belief) or self._timing.due(belief.time, belief.view)
        if self._last is not None and not due:
            return self._last
        scene = gaze_scene(belief, motion, self._samples, self._beacons, self._parameters)
        gaze_map = self._grid.gaze_map(self._votes(scene, belief, task, motion))
        if self._sweeping(belief):
            p = self._parameters.gaze
            self._pan = p.sweep_amplitude * sin(2.0 * pi * belief.time / p.sweep_period)
            self._tilt = p.fixed_tilt
        elif self._parameters.gaze.mode != "fixed":
            self._look(gaze_map)
        self._timing.decided(belief.time, self._pan, self._tilt)
        self._last = GazeDecision(
            pan=self._pan,
            tilt=self._tilt,
            psi_lm=scene.map.psi,
            psi_sf=scene.psi_sf,
            psi_ob=scene.psi_ob_max,
            psi_way=scene.psi_way,
            gaze_map=gaze_map,
        )
        return self._last

    @property
    def grid(self) -> GazeGrid:
        """Cells of the gaze map."""
        return self._grid

    def _sweeping(self, belief: Belief) -> bool:
        """A lost robot sweeps too: it does not know where its beacons are."""
        mode = self._parameters.gaze.mode
        return mode == "sweep" or (belief.lost and mode != "fixed")

    def _votes(
        self, scene: GazeScene, belief: Belief, task: Task, motion: MotionDecision | None
    ) -> Votes:
        if self._parameters.gaze.mode != "deadline":
            return integrated_votes(scene, belief, task, self._parameters)
        way = _way(belief, task, motion)
        return deadline_votes(scene, belief, way, self._limits.forward, self._parameters)

    def _look(self, gaze_map: Array) -> None:
        p = self._parameters.gaze
        ratio = p.deadline.switch_ratio if p.mode == "deadline" else p.switch_ratio
        now = self._grid.value_at(gaze_map, self._pan, self._tilt)
        if float(gaze_map.max()) > ratio * now:
            self._pan, self._tilt = self._grid.highest_centre(gaze_map, self._pan, self._tilt)


def _way(belief: Belief, task: Task, motion: MotionDecision | None) -> float:
    """Bearing of the planned velocity in R, of the destination while standing [rad]."""
    if motion is not None:
        forward, left, _ = motion.velocity.tolist()
        if hypot(forward, left) > 1e-3:
            return atan2(left, forward)
    dx, dy = (task.target - belief.pose[:2]).tolist()
    return wrap(atan2(dy, dx) - float(belief.pose[2]))
