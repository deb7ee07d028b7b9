"""Wrappers of user-defined planners and gazes: defensive copies in, validated decisions out.

A plugin works on copies, so that in-place arithmetic changes neither the belief nor the mission.
Its decisions are validated before walking, log and records use them.
"""

from copy import deepcopy
from dataclasses import replace
from math import isfinite
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsr8.decisions import GazeController, MotionPlanner
from hsr8.errors import UsageError
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision, MotionDecision, Task

Array = NDArray[np.float64]

PLAN = "plan(belief, task)"
CHOOSE = "choose(belief, task, motion)"
VELOCITY = "vx, vy and wz [m/s, m/s, rad/s]"


class PluginPlanner:
    """User-defined planner with copied inputs and validated decisions.

    Args:
        planner: user-defined planner.

    Raises:
        UsageError: `planner` has no method plan; from `plan`: the decision is invalid.
    """

    def __init__(self, planner: MotionPlanner) -> None:
        _require_method(planner, "planner", PLAN)
        self._planner = planner

    def plan(self, belief: Belief, task: Task) -> MotionDecision:
        """Return the validated motion for the next footstep."""
        motion = self._planner.plan(deepcopy(belief), deepcopy(task))
        name = f"planner {_type(self._planner)}"
        _require_type(MotionDecision, motion, name, PLAN)
        if motion.field is not None and not callable(getattr(motion.field, "at", None)):
            raise UsageError(f"{name}: field has no method at(points)")
        if not isinstance(motion.situation, str):
            raise UsageError(f"{name}: situation must be a string, got {_shown(motion.situation)}")
        look_request = motion.look_request
        if look_request is not None:
            look_request = _number(look_request, "look_request", name)
        return replace(
            motion,
            velocity=_velocity(motion.velocity, name),
            direction=_number(motion.direction, "direction", name),
            speed=_number(motion.speed, "speed", name),
            look_request=look_request,
        )


class PluginGaze:
    """User-defined gaze with copied inputs and validated decisions.

    Args:
        gaze: user-defined gaze.

    Raises:
        UsageError: `gaze` has no method choose; from `choose`: the decision is invalid.
    """

    def __init__(self, gaze: GazeController) -> None:
        _require_method(gaze, "gaze", CHOOSE)
        self._gaze = gaze

    def choose(self, belief: Belief, task: Task, motion: MotionDecision | None) -> GazeDecision:
        """Return the validated gaze for this frame."""
        if motion is not None:
            motion = replace(motion, velocity=motion.velocity.copy())
        gaze = self._gaze.choose(deepcopy(belief), deepcopy(task), motion)
        name = f"gaze {_type(self._gaze)}"
        _require_type(GazeDecision, gaze, name, CHOOSE)
        keys = ("pan", "tilt", "psi_lm", "psi_sf", "psi_ob", "psi_way")
        numbers: dict[str, Any] = {key: _number(getattr(gaze, key), key, name) for key in keys}
        return replace(gaze, **numbers, gaze_map=_map(gaze.gaze_map, name))


def _require_method(plugin: object, kind: str, method: str) -> None:
    if isinstance(plugin, type):
        name = plugin.__name__
        raise UsageError(f"{kind}={name}: expected an instance, {kind}={name}(), got the class")
    if not callable(getattr(plugin, method.partition("(")[0], None)):
        raise UsageError(f"{kind} {_type(plugin)} has no method {method}")


def _require_type(expected: type, decision: object, name: str, method: str) -> None:
    if not isinstance(decision, expected):
        raise UsageError(
            f"{name}: {method} must return a {expected.__name__}, got {_shown(decision)}"
        )


def _velocity(value: object, name: str) -> Array:
    """Three finite numbers as an array (3,)."""
    numbers = _numbers(value)
    if numbers is None or numbers.shape != (3,) or not np.isfinite(numbers).all():
        raise UsageError(
            f"{name}: velocity must be three finite numbers, {VELOCITY}, got {_shown(value)}"
        )
    return numbers


def _map(value: object, name: str) -> Array:
    """Finite, non-negative weights (m, n)."""
    weights = _numbers(value)
    if weights is None or weights.ndim != 2 or not (np.isfinite(weights) & (weights >= 0.0)).all():
        raise UsageError(
            f"{name}: gaze_map must be a 2-D array of finite, non-negative numbers, "
            f"got {_shown(value)}"
        )
    return weights


def _numbers(value: object) -> Array | None:
    """Real numbers of any type as an array of floats; None for everything else."""
    try:
        numbers = np.asarray(value)
    except (ValueError, TypeError):  # lists of different lengths, or data on another device
        return None
    return numbers.astype(np.float64) if numbers.dtype.kind in "fiu" else None


def _number(value: object, key: str, name: str) -> float:
    if not isinstance(value, Real) or not isfinite(value):
        raise UsageError(f"{name}: {key} must be a finite number, got {_shown(value)}")
    return float(value)


def _type(value: object) -> str:
    return type(value).__name__


def _shown(value: object) -> str:
    """Type, shape and shortened value."""
    shape = f" of shape {value.shape}" if isinstance(value, np.ndarray) else ""
    text = " ".join(repr(value).split())
    return f"{_type(value)}{shape} {text if len(text) <= 60 else text[:57] + '...'}"
