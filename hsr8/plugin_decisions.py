"""Planners and gazes that do not come with hsr8: they may err, and the run tells how.

What they are given is theirs: a copy, so that arithmetic in place changes neither the belief nor
the mission. What they answer is checked before it reaches walking, log and records.
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
    """A planner that is given copies and whose answers are checked.

    Args:
        planner: to ask.

    Raises:
        UsageError: `planner` has no method plan; from `plan`: it returned no valid MotionDecision.
    """

    def __init__(self, planner: MotionPlanner) -> None:
        _must_answer(planner, "planner", PLAN)
        self._planner = planner

    def plan(self, belief: Belief, task: Task) -> MotionDecision:
        """Motion for the next footstep."""
        motion = self._planner.plan(deepcopy(belief), deepcopy(task))
        who = f"the planner {_name(self._planner)}"
        _must_be(MotionDecision, motion, who, PLAN)
        if motion.field is not None and not callable(getattr(motion.field, "at", None)):
            raise UsageError(f"{who}: field has no method at(points)")
        if not isinstance(motion.situation, str):
            raise UsageError(f"{who}: situation is no text but {_told(motion.situation)}")
        return replace(
            motion,
            velocity=_velocity(motion.velocity, who),
            direction=_number(motion.direction, "direction", who),
            speed=_number(motion.speed, "speed", who),
            look_request=None
            if motion.look_request is None
            else _number(motion.look_request, "look_request", who),
        )


class PluginGaze:
    """A gaze that is given copies and whose answers are checked.

    Args:
        gaze: to ask.

    Raises:
        UsageError: `gaze` has no method choose; from `choose`: it returned no valid GazeDecision.
    """

    def __init__(self, gaze: GazeController) -> None:
        _must_answer(gaze, "gaze", CHOOSE)
        self._gaze = gaze

    def choose(self, belief: Belief, task: Task, motion: MotionDecision | None) -> GazeDecision:
        """Gaze for this frame."""
        if motion is not None:
            motion = replace(motion, velocity=motion.velocity.copy())
        gaze = self._gaze.choose(deepcopy(belief), deepcopy(task), motion)
        who = f"the gaze {_name(self._gaze)}"
        _must_be(GazeDecision, gaze, who, CHOOSE)
        names = ("pan", "tilt", "psi_lm", "psi_sf", "psi_ob", "psi_way")
        numbers: dict[str, Any] = {name: _number(getattr(gaze, name), name, who) for name in names}
        return replace(gaze, **numbers, gaze_map=_map(gaze.gaze_map, who))


def _must_answer(thing: object, kind: str, method: str) -> None:
    """Told before the run begins rather than at its first frame."""
    if isinstance(thing, type):
        name = thing.__name__
        raise UsageError(f"{kind}={name} is a class: give an object of it, {kind}={name}()")
    if not callable(getattr(thing, method.partition("(")[0], None)):
        raise UsageError(f"the {kind} {_name(thing)} has no method {method}")


def _must_be(wanted: type, answer: object, who: str, method: str) -> None:
    if not isinstance(answer, wanted):
        raise UsageError(f"{who}: {method} returns no {wanted.__name__} but {_told(answer)}")


def _velocity(given: object, who: str) -> Array:
    """Three finite numbers as an array (3,)."""
    values = _numbers(given)
    if values is None or values.shape != (3,):
        raise UsageError(f"{who}: velocity must be three numbers, {VELOCITY}, not {_told(given)}")
    if not np.isfinite(values).all():
        raise UsageError(f"{who}: velocity must be finite, {VELOCITY}, not {_told(given)}")
    return values


def _map(given: object, who: str) -> Array:
    """A map of finite weights (m, n)."""
    values = _numbers(given)
    if values is None or values.ndim != 2 or not np.isfinite(values).all() or (values < 0.0).any():
        raise UsageError(
            f"{who}: gaze_map must be an array of two dimensions, finite and nowhere negative, "
            f"not {_told(given)}"
        )
    return values


def _numbers(given: object) -> Array | None:
    """Numbers of any real type as they are computed with; None if they are none."""
    try:
        values = np.asarray(given)
    except (ValueError, TypeError):  # lists of different lengths, or what is on another device
        return None
    return values.astype(np.float64) if values.dtype.kind in "fiu" else None


def _number(given: object, name: str, who: str) -> float:
    if not isinstance(given, Real) or not isfinite(given):
        raise UsageError(f"{who}: {name} must be a finite number, not {_told(given)}")
    return float(given)


def _name(thing: object) -> str:
    return type(thing).__name__


def _told(given: object) -> str:
    """A value in short, with what it is."""
    shape = f" of shape {given.shape}" if isinstance(given, np.ndarray) else ""
    text = " ".join(repr(given).split())
    return f"{_name(given)}{shape} {text if len(text) <= 60 else text[:57] + '...'}"
