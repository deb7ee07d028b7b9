"""Gaze planner: applies the policy of the parameters after every saccade and dwell.

The body of a robot whose camera is fixed turns instead of its head.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision, MotionDecision, SpeedLimits, Task
from navigation.gaze.gaze_map import GazeGrid
from navigation.gaze.policy import GazeContext, SweepGaze, gaze_policy
from navigation.gaze.scene import gaze_scene
from navigation.gaze.timing import GazeTiming
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints

Array = NDArray[np.float64]


class GazePlanner:
    """Gaze control of Yoo & Kim, section II, and alternatives.

    Attributes:
        grid: cells of the gaze map.
    """

    def __init__(
        self,
        parameters: NavigationParameters,
        limits: SpeedLimits,
        beacons: Mapping[str, tuple[float, float]],
        horizontal_fov: float,
        vertical_fov: float,
    ) -> None:
        """Initialize with the gaze straight ahead.

        Args:
            parameters: profile.
            limits: of the walking layer.
            beacons: positions in W by name [m].
            horizontal_fov: of the camera [rad].
            vertical_fov: of the camera [rad].
        """
        p = parameters.gaze
        self._parameters = parameters
        self._beacons = np.array([beacons[name] for name in sorted(beacons)]).reshape(-1, 2)
        self._samples = SamplePoints.polar(parameters.evaluation, p.max_pan)
        self.grid = GazeGrid(p, horizontal_fov, vertical_fov)
        self._policy = gaze_policy(parameters, limits, self.grid)
        # The map of a lost robot does not show where the beacons are.
        searching = p.mode != "fixed" and p.moved_by == "head"
        self._search = SweepGaze(parameters) if searching else self._policy
        self._timing = GazeTiming(p)
        self._pan, self._tilt = 0.0, p.fixed_tilt
        self._direction: float | None = None
        self._last: GazeDecision | None = None

    def choose(self, belief: Belief, task: Task, motion: MotionDecision | None) -> GazeDecision:
        """Choose the gaze; call at every frame.

        Args:
            belief: of the robot.
            task: of the mission.
            motion: decision of the planner, None before the first.

        Returns:
            The decision in force; a new one after the arrival of the head and the dwell.
        """
        policy = self._search if belief.lost else self._policy
        now = self._now(belief)
        error = max(abs(belief.view.pan - self._pan), abs(belief.view.tilt - self._tilt))
        if self._direction is not None:
            error = abs(now[0])
        ready = not policy.steady or self._timing.ready(belief.time, error)
        if self._last is not None and not ready:
            return self._last
        scene = gaze_scene(belief, motion, self._samples, self._beacons, self._parameters)
        context = GazeContext(task, motion, scene)
        gaze_map = self.grid.gaze_map(policy.votes(context))
        self._pan, self._tilt = policy.aim(context, gaze_map, now)
        target = self._pan, self._tilt
        if self._parameters.gaze.moved_by == "body":
            self._direction = wrap(float(belief.pose[2]) + self._pan)
            target = self._direction, self._tilt
        self._timing.decided(belief.time, target)
        self._last = GazeDecision(
            pan=self._pan,
            tilt=self._tilt,
            psi_lm=scene.map.psi,
            psi_sf=scene.psi_sf,
            psi_ob=scene.psi_ob_max,
            psi_way=scene.psi_way,
            gaze_map=gaze_map,
            body_direction=self._direction,
        )
        return self._last

    def _now(self, belief: Belief) -> tuple[float, float]:
        """Return the gaze that was chosen, as seen from the present body [rad]."""
        if self._direction is None:
            return self._pan, self._tilt
        return wrap(self._direction - float(belief.pose[2])), self._tilt
