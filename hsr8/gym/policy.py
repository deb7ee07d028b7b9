"""Policies as plugins: the gaze or planner of ``hsr8 run``, ``sweep`` and ``bench``."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from inspect import signature
from typing import Any, ClassVar

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.gym.action import ActionMap, Part, clipped
from hsr8.gym.observation import MAX_TRACKS, Observation, Observer
from hsr8.plugins.decisions import GazePlugin, Limits, PlannerPlugin
from hsr8.plugins.method import shown
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision, MotionDecision, Task

Array = NDArray[np.float64]


def as_gaze(
    policy: Any,
    *,
    observe: Sequence[str] = (),
    max_tracks: int = MAX_TRACKS,
    normalized: bool = True,
) -> type[GazePlugin]:
    """Return the gaze plugin of a policy, decided from the observations of ``hsr8/Gaze-v0``.

    Args:
        policy: a policy, or a function without arguments that returns one, called once per run.
            A policy has ``predict(observation)``, which returns action and state, or is a function
            of the observation. The last two numbers of the action are pan and tilt.
        observe: optional parts of the observation, without ``image``.
        max_tracks: number of observed tracks.
        normalized: whether actions are from -1 to 1, as in the environments.

    Raises:
        UsageError: an argument is invalid.
    """
    chosen = _Options(policy, observe, max_tracks, normalized)

    class PolicyGaze(_Plugin):
        """Gaze of a policy."""

        options, part = chosen, "gaze"

        def choose(self, belief: Belief, task: Task, motion: MotionDecision | None) -> GazeDecision:
            """Return the gaze of the policy."""
            action = self._act(belief, task)
            if motion is not None:
                self._observer.velocity = motion.velocity
            return GazeDecision(*self._actions.gaze(action))

    return PolicyGaze


def as_planner(
    policy: Any,
    *,
    observe: Sequence[str] = (),
    max_tracks: int = MAX_TRACKS,
    normalized: bool = True,
) -> type[PlannerPlugin]:
    """Return the planner plugin of a policy, decided from the observations of ``hsr8/Navigate-v0``.

    Args:
        policy: policy, see `as_gaze`. The first three numbers of the action are vx, vy and wz.
        observe: optional parts of the observation, without ``image``.
        max_tracks: number of observed tracks.
        normalized: whether actions are from -1 to 1, as in the environments.

    Raises:
        UsageError: an argument is invalid.
    """
    chosen = _Options(policy, observe, max_tracks, normalized)

    class PolicyPlanner(_Plugin):
        """Planner of a policy."""

        options, part = chosen, "motion"

        def plan(self, belief: Belief, task: Task, look: float | None = None) -> MotionDecision:
            """Return the velocity of the policy."""
            self._observer.velocity = self._actions.velocity(self._act(belief, task))
            return MotionDecision(velocity=self._observer.velocity)

    return PolicyPlanner


@dataclass(frozen=True)
class _Options:
    """Arguments of `as_gaze` and `as_planner`.

    Raises:
        UsageError: one is invalid; plugins receive the belief, not the image.
    """

    policy: Any
    observe: Sequence[str]
    max_tracks: int
    normalized: bool

    def __post_init__(self) -> None:
        _require_policy(self.policy)
        Observer(self.observe, self.max_tracks)
        if "image" in self.observe:
            raise UsageError("observe: plugins receive the belief, got 'image'; expected local_map")


class _Plugin:
    """Policy with the observations and actions of one run."""

    options: ClassVar[_Options]
    part: ClassVar[Part]

    def __init__(self) -> None:
        self._observer = Observer(self.options.observe, self.options.max_tracks)
        self._policy = _Policy(self.options.policy)

    def start(self, limits: Limits) -> None:
        """Map actions to these limits."""
        self._actions = ActionMap(limits, normalized=self.options.normalized)
        self._spaces = self._actions.spaces(self.part)

    def _act(self, belief: Belief, task: Task) -> Array:
        return self._policy(self._observer.observe(belief, task), self._spaces)


def _require_policy(policy: object) -> None:
    """Require a function or an object with the method `predict`.

    Raises:
        UsageError: `policy` is anything else.
    """
    if not callable(getattr(policy, "predict", policy)):
        raise UsageError(
            f"policy: got {shown(policy)}; expected an object with predict(observation) or a "
            "function of the observation"
        )


def _makes_policy(policy: Any) -> bool:
    """Return whether `policy` is a class or function that takes no arguments."""
    if hasattr(policy, "predict") and not isinstance(policy, type):
        return False
    try:
        signature(policy).bind()
    except TypeError:
        return False
    return True


class _Policy:
    """Actions of a policy in the order of the observations.

    Raises:
        UsageError: `policy` is not a policy.
    """

    def __init__(self, policy: Any) -> None:
        if _makes_policy(policy):
            policy = policy()
        _require_policy(policy)
        self._predict: Callable[..., Any] = getattr(policy, "predict", policy)
        self._has_state = hasattr(policy, "predict")
        self._accepted = signature(self._predict).parameters.keys()
        self._state: Any = None
        self._first = True

    def __call__(self, observation: Observation, allowed: Sequence[spaces.Box]) -> Array:
        """Return the action for an observation, clipped to its space.

        Args:
            observation: observation of the belief.
            allowed: spaces of the action.

        Raises:
            UsageError: the action has another shape, or a value is not finite.
        """
        options = {
            "state": self._state,
            "episode_start": np.array([self._first]),
            "deterministic": True,
        }
        accepted = {key: value for key, value in options.items() if key in self._accepted}
        action = self._predict(observation, **accepted)
        if self._has_state:
            action, self._state = action
        self._first = False
        return clipped(action, *allowed)
