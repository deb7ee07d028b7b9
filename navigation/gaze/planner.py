"""Gaze planner: applies the policy of the mode, a steady one after saccade and dwell.

The body of a robot whose camera is fixed turns instead of its head.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision, MotionDecision, SpeedLimits
from navigation.gaze.blind import BlindGaze, StepSweep, TriangleSweep
from navigation.gaze.grid import GazeGrid
from navigation.gaze.integrated import IntegratedGaze
from navigation.gaze.memory import Fixation, GazeMemory
from navigation.gaze.policy import Gaze, GazePolicy
from navigation.gaze.risk import RiskGaze
from navigation.gaze.scene import GazeScene
from navigation.parameters.gaze import GazeParameters
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints
from navigation.scene import Scene

Array = NDArray[np.float64]


class GazePlanner:
    """Gaze control of Yoo & Kim, section II, and alternatives.

    The planner does not change: all that lives from frame to frame is a `GazeMemory`.

    Args:
        parameters: profile.
        limits: speed limits of the walking layer.
        beacons: positions in W by name [m].
        neck: maximum rate [rad/s] and acceleration [rad/s²] of the camera.

    Attributes:
        grid: cells of the gaze map.
    """

    def __init__(
        self,
        parameters: NavigationParameters,
        limits: SpeedLimits,
        beacons: Mapping[str, tuple[float, float]],
        neck: tuple[float, float],
    ) -> None:
        p = parameters.gaze
        self._parameters = parameters
        self._beacons = np.array([beacons[name] for name in sorted(beacons)]).reshape(-1, 2)
        self._samples = SamplePoints.polar(parameters.evaluation, p.max_pan)
        self.grid = GazeGrid.of(p)
        self._policy: GazePolicy[Any]
        if p.mode == "risk":
            self._policy = RiskGaze(parameters, limits, self.grid, self._beacons, neck)
        elif p.mode == "integrated":
            self._policy = IntegratedGaze(parameters, self.grid)
        else:
            self._policy = blind_policy(p, self.grid)
        self._search = search_policy(p, self.grid)

    def begin(self) -> GazeMemory:
        """Return the memory of the start, also after a relocalization or a fall."""
        return GazeMemory(None, self._policy.begin(), self._search.begin())

    def choose(
        self, memory: GazeMemory, scene: Scene, motion: MotionDecision | None
    ) -> tuple[GazeDecision, GazeMemory]:
        """Choose the gaze; call at every frame.

        Args:
            memory: memory that the former frame returned.
            scene: scene of the frame.
            motion: decision of the motion planner; None before the first.

        Returns:
            The decision in force, of a steady policy a new one after arrival and dwell, and the
            memory for the next frame.
        """
        belief, p, fixation = scene.belief, self._parameters.gaze, memory.fixation
        memory = replace(memory, policy=self._policy.observe(memory.policy, belief))
        policy = self._search if belief.lost else self._policy
        by_body = p.moved_by == "body"
        held = by_body or policy.stabilized
        now = self._present(fixation, belief, held)
        if policy.steady and fixation is not None:
            fixation = fixation.observed(belief.time, self._error(belief, now), p)
            if not fixation.is_over(belief.time, p):
                memory = replace(memory, fixation=fixation)
                return replace(fixation.decision, pan=now[0]), memory
        gaze_scene = GazeScene.of(scene, motion, self._samples, self._beacons, self._parameters)
        former = memory.search if belief.lost else memory.policy
        (pan, tilt), gaze_map, later = policy.look(former, gaze_scene, now)
        direction = wrap(float(belief.pose[2]) + pan)
        decision = GazeDecision(
            pan=pan,
            tilt=tilt,
            psi_lm=gaze_scene.map.psi,
            psi_sf=gaze_scene.psi_sf,
            psi_ob=gaze_scene.psi_ob_max,
            psi_way=gaze_scene.psi_way,
            gaze_map=gaze_map,
            stabilized=policy.stabilized,
            body_direction=direction if by_body else None,
        )
        kept = fixation is not None and fixation.is_kept_by(decision, direction, held)
        arrived = fixation.arrived if fixation is not None and kept else None
        fixation = Fixation(decision, direction, belief.time, arrived)
        if belief.lost:
            return decision, GazeMemory(fixation, memory.policy, later)
        return decision, GazeMemory(fixation, later, memory.search)

    def _present(self, fixation: Fixation | None, belief: Belief, held: bool) -> Gaze:
        """Return the gaze that was chosen [rad]; one that is `held` keeps its direction in W."""
        if fixation is None:
            return 0.0, self._parameters.gaze.fixed_tilt
        if not held:
            return fixation.decision.pan, fixation.decision.tilt
        limit = self._parameters.gaze.max_pan
        pan = wrap(fixation.direction - float(belief.pose[2]))
        return min(max(pan, -limit), limit), fixation.decision.tilt

    def _error(self, belief: Belief, now: Gaze) -> float:
        """Return the angle between the camera and the chosen gaze [rad]."""
        if self._parameters.gaze.moved_by == "body":
            return abs(now[0])
        return max(abs(belief.view.pan - now[0]), abs(belief.view.tilt - now[1]))


def blind_policy(parameters: GazeParameters, grid: GazeGrid) -> GazePolicy[Any]:
    """Return the policy of a mode that depends on time alone."""
    if parameters.mode == "steps":
        return StepSweep(parameters, grid)
    if parameters.mode == "triangle":
        return TriangleSweep(parameters, grid)
    return BlindGaze(parameters, grid)


def search_policy(parameters: GazeParameters, grid: GazeGrid) -> GazePolicy[Any]:
    """Return the policy of a lost robot, whose map does not show where the beacons are."""
    p = parameters
    if p.mode == "fixed" or p.moved_by == "body":
        return BlindGaze(p, grid)
    search = replace(p, sweep_amplitude=p.max_pan, sweep_stops=4, sweep_frames=2)
    return StepSweep(search, grid)
