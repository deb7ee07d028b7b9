"""Environment: a run in which a policy decides gaze, motion or both."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.gym.action import SIZES, ActionMap, Part, clipped
from hsr8.gym.episode import FAILURES, Episode
from hsr8.gym.observation import MAX_TRACKS, Observation, Observer, require_names
from hsr8.gym.outside_view import OutsideView
from hsr8.gym.reward import WEIGHTS, Reward
from hsr8.process import arithmetic
from hsr8.robots.loaded import load_robot
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import MAX_SEED, Scenario
from hsr8.simulation.robot_builder import decision_limits, require_planner

RENDER_MODES = ("rgb_array",)
TERMINAL = ("goal", *FAILURES)  # exit reasons; a run that ends by another one is truncated


class Environment(gymnasium.Env[Observation, NDArray[Any]]):
    """Gymnasium environment of a scenario.

    A step lasts until the next decision: a camera frame, or a footstep if only motion is decided.
    An action is (vx, vy, wz), (pan, tilt) or both in this order; the velocity counts at footsteps.

    Args:
        scenario: name of a built-in scenario, or TOML file.
        decides: parts that the action decides; the robot decides the rest.
        normalized: whether actions are from -1 to 1; if not, in [m/s], [rad/s] and [rad].
        settings: override those of the scenario, as ``key=value`` or by dotted key.
        observe: optional parts of the observation: ``local_map``, ``image``.
        max_tracks: number of observed tracks, the nearest first.
        reward: weights that replace those of `hsr8.gym.reward.WEIGHTS`.
        end_on_contact: end at the first contact with an obstacle; if not, as ``hsr8 run``.
        render_mode: ``rgb_array`` for images from outside; None for no images.

    Attributes:
        scenario: scenario with its settings.

    Raises:
        ScenarioError: the scenario or a setting is invalid.
        UsageError: another argument is invalid.
    """

    metadata: dict[str, Any] = {"render_modes": [*RENDER_MODES]}  # noqa: RUF012  as in the base

    def __init__(
        self,
        scenario: str | Path = "crowd",
        *,
        decides: Sequence[Part] = ("motion", "gaze"),
        normalized: bool = True,
        settings: Sequence[str] | Mapping[str, Any] = (),
        observe: Sequence[str] = (),
        max_tracks: int = MAX_TRACKS,
        reward: Mapping[str, float] | None = None,
        end_on_contact: bool = True,
        render_mode: str | None = None,
    ) -> None:
        if render_mode not in (None, *RENDER_MODES):
            raise UsageError(
                f"render_mode: unknown mode, got {render_mode!r}; expected "
                f"{', '.join(RENDER_MODES)} or None"
            )
        require_names("decides", decides, SIZES)
        require_names("reward", reward or (), WEIGHTS)
        observer = Observer(observe, max_tracks)
        weights = {**WEIGHTS, **(reward or {})}
        self.scenario = load_scenario(str(scenario), settings)
        _require_decisions(self.scenario, decides)
        camera = self.scenario.camera
        if "image" in observe and camera.source != "rendered":
            raise UsageError(
                f"observe: an image requires camera.source = 'rendered', got {camera.source!r}"
            )
        if "gaze" not in decides and "tracking" not in (reward or {}):
            weights["tracking"] = 0.0
        footstep = self.scenario.speed_limits().footstep
        period = camera.period_ms / 1000 if "gaze" in decides else footstep
        self.metadata = {**self.metadata, "render_fps": 1.0 / period}
        self.render_mode = render_mode
        self._decides, self._weights = tuple(decides), weights
        self._end_on_contact = end_on_contact
        self._observe_options = observe, max_tracks
        self._actions = ActionMap(decision_limits(self.scenario), normalized=normalized)
        self._box = self.action_space = self._actions.space(decides)
        self.observation_space = observer.space(camera.width, camera.height)
        self._episode: Episode | None = None
        self._view: OutsideView | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Start a run.

        Args:
            seed: seed of the run; by default drawn, reproducibly after a given seed.
            options: must be empty; the options of a run are those of the environment.

        Returns:
            The observation at the first decision, and info.

        Raises:
            ScenarioError: the world cannot be drawn.
            RenderingUnavailable: the camera needs OpenGL and there is none.
            UsageError: the run ends before the first decision, or `options` are given.
        """
        if options:
            raise UsageError(f"options: got {options}; expected None: settings are arguments")
        super().reset(seed=seed)
        self.close()
        with ExitStack() as failed:
            episode = Episode(
                self.scenario,
                int(self.np_random.integers(MAX_SEED + 1)) if seed is None else seed,
                footsteps="gaze" not in self._decides,
                end_on_contact=self._end_on_contact,
            )
            failed.callback(episode.close)
            if not episode.advance():
                raise UsageError(
                    "duration: the run ends before the first decision, got "
                    f"{self.scenario.duration:g}"
                )
            failed.pop_all()
        self._episode = episode
        self._observer = Observer(*self._observe_options)
        self._reward = Reward(episode.simulation.layout, self._weights)
        self._reward.start(episode.truth)
        return self._observe(episode), self._info(episode)

    def step(self, action: NDArray[Any]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Decide, and run to the next decision; an action is clipped to its space.

        Raises:
            UsageError: `action` has another shape, or a value is not finite.
            RuntimeError: the run has ended.
        """
        episode = self._episode
        if episode is None or episode.exit_reason:
            reason = "the run has ended" if episode else "no run has begun"
            raise RuntimeError(f"step: {reason}; expected reset()")
        values = clipped(action, self._box)
        if "gaze" in self._decides:
            episode.simulation.look(*self._actions.gaze(values))
        if "motion" in self._decides and episode.situation.motion_due:
            episode.simulation.command(*self._actions.velocity(values).tolist())
        episode.complete()
        info, success = {}, False
        if not episode.advance():
            results = episode.run().metrics
            success = bool(results["success"])
            info = {"exit_reason": episode.exit_reason, "metrics": results}
        outcome = success - (episode.exit_reason in FAILURES)
        terms = self._reward.terms(episode.truth, episode.situation, outcome)
        info |= self._info(episode) | {"is_success": success, "reward_terms": terms}
        terminated = episode.exit_reason in TERMINAL
        truncated = bool(episode.exit_reason) and not terminated
        return self._observe(episode), sum(terms.values()), terminated, truncated, info

    def render(self) -> NDArray[np.uint8] | None:
        """Return an image of the present world from outside (height, width, 3).

        Without `render_mode`, warn and return None, as the environments of Gymnasium.

        Raises:
            RenderingUnavailable: there is no OpenGL.
        """
        if self.render_mode is None:
            gymnasium.logger.warn(
                f"render_mode: render() has no mode, got None; expected {', '.join(RENDER_MODES)}"
            )
            return None
        if self._episode is None:
            return None
        if self._view is None:
            self._view = OutsideView(self._episode.simulation, self.metadata["render_fps"])
        return self._view.draw(self._episode.truth)

    def close(self) -> None:
        """End the run."""
        if self._view is not None:
            self._view.close()
        if self._episode is not None:
            self._episode.close()
        self._view = self._episode = None

    def _observe(self, episode: Episode) -> Observation:
        situation = episode.situation
        if situation.motion is not None:
            self._observer.velocity = situation.motion.velocity
        return self._observer.observe(situation.belief, situation.task, situation.image)

    def _info(self, episode: Episode) -> dict[str, Any]:
        """Return seed, arithmetic, time [s] and ground truth, which the robot does not know."""
        truth = episode.truth
        return {
            "seed": episode.simulation.seed,
            "arithmetic": arithmetic.IN_FORCE,
            "time": episode.simulation.time,
            "motion_due": episode.situation.motion_due,
            "truth": {
                "robot": truth.robot,
                "obstacle_positions": truth.obstacle_positions,
                "obstacle_velocities": truth.obstacle_velocities,
                "clearance": truth.clearance,
            },
            "is_success": False,
        }


def _require_decisions(scenario: Scenario, decides: Sequence[Part]) -> None:
    """Require a mission with a planner for motion, and a movable head for the gaze.

    Raises:
        UsageError: one of them is missing.
    """
    if "motion" in decides:
        require_planner(scenario)
    if "gaze" in decides and load_robot(scenario.robot.model).model.tree.head is None:
        raise UsageError(
            f"robot.model: the head does not move, got {scenario.robot.model!r}; expected a robot "
            "with a movable head, or hsr8/Navigate-v0"
        )
