"""Where to look, decided again after every saccade by the policy the parameters name."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

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
        self._beacons = np.array([beacons[name] for name in sorted(beacons)]).reshape(-1, 2)
        self._samples = SamplePoints.polar(parameters.evaluation, p.max_pan)
        self._grid = GazeGrid(
            max_pan=p.max_pan,
            min_tilt=p.min_tilt,
            max_tilt=p.max_tilt,
            step=p.step,
            half_pan=p.box_fraction * horizontal_fov,
            half_tilt=p.box_fraction * vertical_fov,
        )
        self._policy = gaze_policy(parameters, limits, self._grid)
        # A lost robot does not know where its beacons are.
        self._search = self._policy if p.mode == "fixed" else SweepGaze(parameters)
        self._timing = GazeTiming(p.dwell, p.arrival_tolerance, p.max_saccade_time)
        self._pan, self._tilt = 0.0, p.fixed_tilt
        self._last: GazeDecision | None = None

    def choose(self, belief: Belief, task: Task, motion: MotionDecision | None) -> GazeDecision:
        """Choose the gaze; call at every frame.

        Args:
            belief: what the robot believes.
            task: where it goes.
            motion: how it moves, None before the first plan.

        Returns:
            The decision in force, a new one once the head has arrived and rested.
        """
        policy = self._search if belief.lost else self._policy
        due = not policy.steady or self._timing.due(belief.time, belief.view)
        if self._last is not None and not due:
            return self._last
        scene = gaze_scene(belief, motion, self._samples, self._beacons, self._parameters)
        context = GazeContext(belief, task, motion, scene)
        gaze_map = self._grid.gaze_map(policy.votes(context))
        self._pan, self._tilt = policy.aim(context, gaze_map, (self._pan, self._tilt))
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
