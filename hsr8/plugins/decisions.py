"""Wrappers of user-defined planners and gazes: defensive copies in, validated decisions out.

A plugin works on copies, so that in-place arithmetic changes neither the belief nor the mission.
Its decisions are validated before walking, log and records use them.
"""

from copy import deepcopy
from dataclasses import replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from hsr8.errors import UsageError
from hsr8.plugins.file import start_plugin
from hsr8.plugins.method import (
    PluginMethod,
    number,
    numbers,
    shown,
    start_of_memory,
    takes_memory,
)
from navigation.decision import GazeDecision, MotionDecision, SpeedLimits
from navigation.scene import Scene

Array = NDArray[np.float64]

VELOCITY = "vx, vy and wz [m/s, m/s, rad/s]"


class PlannerPlugin(Protocol):
    """User-defined planner: ``plan(belief, task)``, or ``plan(memory, scene)``."""

    def plan(self, *inputs: Any) -> Any:
        """Return the `MotionDecision`, in the second form and the memory."""


class GazePlugin(Protocol):
    """User-defined gaze: ``choose(belief, task, motion)`` or ``choose(memory, scene, motion)``."""

    def choose(self, *inputs: Any) -> Any:
        """Return the `GazeDecision`, in the second form and the memory."""


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

    Its method is ``plan(belief, task)``, or ``plan(memory, scene)``, which returns decision and
    memory. At the start, after a fall and after a relocalization the memory is the result of the
    optional method ``begin()``, or None.

    Args:
        planner: user-defined planner.
        limits: limits for its optional method `start`.

    Raises:
        UsageError: `planner` has no method plan, or its start failed; from `plan`: the decision
            is invalid.
    """

    def __init__(self, planner: PlannerPlugin, limits: Limits) -> None:
        self._remembers = takes_memory(planner, "plan", ("memory", "scene"))
        signature = "plan(memory, scene)" if self._remembers else "plan(belief, task)"
        self._plan = PluginMethod(planner, "planner", signature, MotionDecision)
        start_plugin(planner, self._plan.name, limits)
        self._begin = start_of_memory(planner, self._remembers)

    def begin(self) -> object:
        """Return the memory at the start."""
        return self._begin()

    def plan(self, memory: object, scene: Scene) -> tuple[MotionDecision, object]:
        """Return the validated motion for the next footstep, and the memory."""
        if self._remembers:
            motion, memory = self._plan.with_memory(memory, deepcopy(scene))
        else:
            belief = replace(scene.belief, tracks=scene.obstacles)
            motion = self._plan(deepcopy(belief), deepcopy(scene.task))
        name = self._plan.name
        if motion.field is not None and not callable(getattr(motion.field, "at", None)):
            raise UsageError(f"{name}: field has no method at(points)")
        if not isinstance(motion.situation, str):
            raise UsageError(f"{name}: situation must be a string, got {shown(motion.situation)}")
        checked = replace(
            motion,
            velocity=_velocity(motion.velocity, name),
            direction=number(motion.direction, "direction", name),
            speed=number(motion.speed, "speed", name),
        )
        return checked, memory


class PluginGaze:
    """User-defined gaze with copied inputs and validated decisions.

    Its method is ``choose(belief, task, motion)``, or ``choose(memory, scene, motion)``, which
    returns decision and memory; for the memory at the start see `PluginPlanner`.

    Args:
        gaze: user-defined gaze.
        limits: limits for its optional method `start`.

    Raises:
        UsageError: `gaze` has no method choose, or its start failed; from `choose`: the decision
            is invalid.
    """

    def __init__(self, gaze: GazePlugin, limits: Limits) -> None:
        self._remembers = takes_memory(gaze, "choose", ("memory", "scene", "motion"))
        inputs = "memory, scene, motion" if self._remembers else "belief, task, motion"
        self._choose = PluginMethod(gaze, "gaze", f"choose({inputs})", GazeDecision)
        start_plugin(gaze, self._choose.name, limits)
        self._begin = start_of_memory(gaze, self._remembers)

    def begin(self) -> object:
        """Return the memory at the start."""
        return self._begin()

    def choose(
        self, memory: object, scene: Scene, motion: MotionDecision | None
    ) -> tuple[GazeDecision, object]:
        """Return the validated gaze for this frame, and the memory."""
        if motion is not None:
            motion = replace(motion, velocity=motion.velocity.copy())
        if self._remembers:
            gaze, memory = self._choose.with_memory(memory, deepcopy(scene), motion)
        else:
            gaze = self._choose(deepcopy(scene.belief), deepcopy(scene.task), motion)
        name = self._choose.name
        keys = ("pan", "tilt", "psi_lm", "psi_sf", "psi_ob", "psi_way")
        values: dict[str, Any] = {key: number(getattr(gaze, key), key, name) for key in keys}
        if gaze.body_direction is not None:
            values["body_direction"] = number(gaze.body_direction, "body_direction", name)
        return replace(gaze, **values, gaze_map=_map(gaze.gaze_map, name)), memory


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
