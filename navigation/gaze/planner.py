"""Gaze planner: applies the policy of the parameters, a steady one after saccade and dwell.

The body of a robot whose camera is fixed turns instead of its head.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision, MotionDecision, SpeedLimits, Task
from navigation.gaze.choice import gaze_policy, search_policy
from navigation.gaze.gaze_map import GazeGrid
from navigation.gaze.policy import GazeContext
from navigation.gaze.scene import gaze_scene
from navigation.parameters.gaze import GazeParameters
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints


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
        fov: tuple[float, float],
        neck: tuple[float, float],
    ) -> None:
        """Initialize with the gaze straight ahead.

        Args:
            parameters: profile.
            limits: speed limits of the walking layer.
            beacons: positions in W by name [m].
            fov: horizontal and vertical field of view of the camera [rad].
            neck: maximum rate [rad/s] and acceleration [rad/s²] of the camera.
        """
        p = parameters.gaze
        self._parameters = parameters
        self._beacons = np.array([beacons[name] for name in sorted(beacons)]).reshape(-1, 2)
        self._samples = SamplePoints.polar(parameters.evaluation, p.max_pan)
        self.grid = GazeGrid(p, *fov)
        self._policy = gaze_policy(parameters, limits, self.grid, self._beacons, neck)
        self._search = search_policy(parameters, self.grid)
        self._timing = GazeTiming(p)
        self._pan, self._tilt = 0.0, p.fixed_tilt
        self._direction: float | None = None
        self._last: GazeDecision | None = None

    def choose(self, belief: Belief, task: Task, motion: MotionDecision | None) -> GazeDecision:
        """Choose the gaze; call at every frame.

        Args:
            belief: belief of the robot.
            task: task of the mission.
            motion: decision of the planner, None before the first.

        Returns:
            The decision in force; of a steady policy a new one after arrival and dwell.
        """
        self._policy.observe(belief)
        policy = self._search if belief.lost else self._policy
        by_body = self._parameters.gaze.moved_by == "body"
        now = self._now(belief, policy.stabilized or by_body)
        if by_body:
            error = abs(now[0])
        else:
            error = max(abs(belief.view.pan - now[0]), abs(belief.view.tilt - now[1]))
        ready = not policy.steady or self._timing.ready(belief.time, error)
        if self._last is not None and not ready:
            return replace(self._last, pan=now[0])
        scene = gaze_scene(belief, motion, self._samples, self._beacons, self._parameters)
        gaze_map, (self._pan, self._tilt) = policy.look(GazeContext(task, motion, scene), now)
        self._direction = wrap(float(belief.pose[2]) + self._pan)
        held = by_body or policy.stabilized
        self._timing.decided(belief.time, (self._direction if held else self._pan, self._tilt))
        self._last = GazeDecision(
            pan=self._pan,
            tilt=self._tilt,
            psi_lm=scene.map.psi,
            psi_sf=scene.psi_sf,
            psi_ob=scene.psi_ob_max,
            psi_way=scene.psi_way,
            gaze_map=gaze_map,
            stabilized=policy.stabilized,
            body_direction=self._direction if by_body else None,
        )
        return self._last

    def _now(self, belief: Belief, held: bool) -> tuple[float, float]:
        """Return the gaze that was chosen [rad]; one that is `held` keeps its direction in W."""
        if self._direction is None or not held:
            return self._pan, self._tilt
        pan, limit = wrap(self._direction - float(belief.pose[2])), self._parameters.gaze.max_pan
        return min(max(pan, -limit), limit), self._tilt


class GazeTiming:
    """Timing of decisions: the gaze arrives and dwells before the next one."""

    def __init__(self, parameters: GazeParameters) -> None:
        self._parameters = parameters
        self._target = (0.0, 0.0)
        self._decided: float | None = None
        self._arrived: float | None = None

    def ready(self, time: float, error: float) -> bool:
        """Whether to decide at `time` [s] with the camera `error` [rad] from its target."""
        if self._decided is None:
            return True
        p = self._parameters
        if self._arrived is None and error <= p.arrival_tolerance:
            self._arrived = time
        dwelled = self._arrived is not None and time - self._arrived >= p.dwell - 1e-9
        most = p.max_saccade_time if p.moved_by == "head" else p.max_turn_time
        return dwelled or time - self._decided >= most

    def decided(self, time: float, target: tuple[float, float]) -> None:
        """Record a decision at `time` [s] for a target."""
        if self._decided is None or target != self._target:
            self._arrived = None
        self._target = target
        self._decided = time
