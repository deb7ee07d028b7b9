"""Model predictive path integral control, Williams et al. 2017.

G. Williams, A. Aldrich, E. Theodorou, "Model predictive path integral control: from theory
to parallel computation", J. Guidance, Control and Dynamics 40(2). Obstacles are predicted at
constant velocity; the sampled sequences obey the acceleration limits of the body.
"""

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap_array
from navigation.baselines.baseline_planner import Avoidance
from navigation.baselines.planning_scene import PlanningScene
from navigation.baselines.rollout import contact_cost, gaps, rollout
from navigation.parameters.planner import MppiParameters

Array = NDArray[np.float64]

_MIRROR = np.array([1.0, -1.0, -1.0])


class PathIntegral(Avoidance):
    """Mean of sampled sequences of footsteps, weighted by the exponential of their cost."""

    def __init__(self, parameters: MppiParameters, rng: np.random.Generator) -> None:
        """Start with a plan of zeros; `rng` draws the samples."""
        self.margin = parameters.margin
        self._parameters = parameters
        self._rng = rng
        self._plan = np.zeros((parameters.steps, 3))
        lag = np.arange(parameters.steps)
        rho = parameters.persistence
        power = rho ** np.maximum(0, lag[:, None] - lag)
        drive = np.where(lag == 0, 1.0, np.sqrt(1.0 - rho**2))
        self._correlation = np.tril(power) * drive

    def decide(self, scene: PlanningScene) -> Array:
        s = scene
        body = self._samples(s)
        cost = self._cost(s, body)
        weight = np.exp(-(cost - cost.min()) / self._parameters.temperature)
        plan = np.einsum("k,kti->ti", weight / weight.sum(), body)
        self._plan = np.concatenate([plan[1:], plan[-1:]])
        first: Array = plan[0]
        return first

    def _samples(self, s: PlanningScene) -> Array:
        """Return samples around the plan (k, t, 3), mirrored in pairs, the plan and zeros."""
        p = self._parameters
        low, high, change = s.low(), s.high(), s.change()
        white = self._rng.standard_normal((p.samples // 2, p.steps, 3))
        noise = p.spread * high * np.einsum("ts,ksi->kti", self._correlation, white)
        zeros = np.zeros((1, p.steps, 3))
        mirrored = self._plan + _MIRROR * noise
        samples = np.concatenate([self._plan + noise, mirrored, self._plan[None], zeros])
        samples = np.clip(samples, low, high)
        start = np.broadcast_to(s.body, (len(samples), 1, 3))
        steps = np.diff(samples, axis=1, prepend=start)
        reached = s.body + np.cumsum(np.clip(steps, -change, change), axis=1)
        body: Array = np.clip(reached, low, high)
        return body

    def _cost(self, s: PlanningScene, body: Array) -> Array:
        """Return the cost of every sequence (k,)."""
        p, limits = self._parameters, s.limits
        position, heading = rollout(s.pose, body, limits.footstep)
        to_go = s.task.target - position
        distance = np.hypot(to_go[..., 0], to_go[..., 1])
        # The costs of walking and of standing differ by one.
        walked = 0.5 * p.steps * limits.footstep * limits.vx
        facing = np.arctan2(to_go[..., 1], to_go[..., 0]) if s.facing is None else s.facing
        heading_error = np.abs(wrap_array(facing - heading))
        if s.facing is None:
            heading_error = heading_error * np.minimum(1.0, distance / 0.2)
        gap = gaps(position, s, s.s_robot + s.radii(p.margin), p.clearance)
        cost: Array = (
            distance.mean(axis=1) / walked
            + p.heading_weight * heading_error.mean(axis=1) / np.pi
            + p.clearance_weight * np.maximum(0.0, 1.0 - gap / p.clearance).mean(axis=1)
            + p.contact_weight * contact_cost(gap)
        )
        return cost
