"""Wrappers of user-defined planners and gazes: defensive copies in, validated decisions out.

A plugin works on copies, so that in-place arithmetic changes neither the belief nor the mission.
Its decisions are validated before walking, log and records use them.
"""

from copy import deepcopy
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from hsr8.decisions import GazeController, MotionPlanner
from hsr8.errors import UsageError
from hsr8.plugin_file import start_plugin
from hsr8.plugin_method import PluginMethod, number, numbers, shown
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision, MotionDecision, SpeedLimits, Task

Array = NDArray[np.float64]

VELOCITY = "vx, vy and wz [m/s, m/s, rad/s]"


@value
class Limits:
    """Limits that a planner or gaze may receive before a run, by its method ``start(limits)``.

    Attributes:
        speed: speed of the built-in planners.
        neck: lower and upper limit of pan and tilt (2, 2) [rad].
    """

    speed: SpeedLimits
    neck: Array


class PluginPlanner:
    """User-defined planner with copied inputs and validated decisions.

    Args:
        planner: user-defined planner.
        limits: limits for its optional method `start`.

    Raises:
        UsageError: `planner` has no method plan, or its start failed; from `plan`: the decision
            is invalid.
    """

    def __init__(self, planner: MotionPlanner, limits: Limits) -> None:
        self._plan = PluginMethod(planner, "planner", "plan(belief, task)", MotionDecision)
        start_plugin(planner, self._plan.name, limits)

    def plan(self, belief: Belief, task: Task, look: float | None = None) -> MotionDecision:
        """Return the validated motion for the next footstep."""
        motion, name = self._plan(deepcopy(belief), deepcopy(task)), self._plan.name
        if motion.field is not None and not callable(getattr(motion.field, "at", None)):
            raise UsageError(f"{name}: field has no method at(points)")
        if not isinstance(motion.situation, str):
            raise UsageError(f"{name}: situation must be a string, got {shown(motion.situation)}")
        return replace(
            motion,
            velocity=_velocity(motion.velocity, name),
            direction=number(motion.direction, "direction", name),
            speed=number(motion.speed, "speed", name),
        )


class PluginGaze:
    """User-defined gaze with copied inputs and validated decisions.

    Args:
        gaze: user-defined gaze.
        limits: limits for its optional method `start`.

    Raises:
        UsageError: `gaze` has no method choose, or its start failed; from `choose`: the decision
            is invalid.
    """

    def __init__(self, gaze: GazeController, limits: Limits) -> None:
        self._choose = PluginMethod(gaze, "gaze", "choose(belief, task, motion)", GazeDecision)
        start_plugin(gaze, self._choose.name, limits)

    def choose(self, belief: Belief, task: Task, motion: MotionDecision | None) -> GazeDecision:
        """Return the validated gaze for this frame."""
        if motion is not None:
            motion = replace(motion, velocity=motion.velocity.copy())
        gaze, name = self._choose(deepcopy(belief), deepcopy(task), motion), self._choose.name
        keys = ("pan", "tilt", "psi_lm", "psi_sf", "psi_ob", "psi_way")
        values: dict[str, Any] = {key: number(getattr(gaze, key), key, name) for key in keys}
        return replace(gaze, **values, gaze_map=_map(gaze.gaze_map, name))


def _velocity(value: object, name: str) -> Array:
    """Three finite numbers as an array (3,)."""
    velocity = numbers(value)
    if velocity is None or velocity.shape != (3,) or not np.isfinite(velocity).all():
        raise UsageError(
            f"{name}: velocity must be three finite numbers, {VELOCITY}, got {shown(value)}"
        )
    return velocity


def _map(value: object, name: str) -> Array:
    """Finite, non-negative weights (m, n)."""
    weights = numbers(value)
    if weights is None or weights.ndim != 2 or not (np.isfinite(weights) & (weights >= 0.0)).all():
        raise UsageError(
            f"{name}: gaze_map must be a 2-D array of finite, non-negative numbers, "
            f"got {shown(value)}"
        )
    return weights
