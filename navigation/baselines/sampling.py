"""Baselines that roll out sampled footsteps: dynamic window and path integral control.

Dynamic window: D. Fox, W. Burgard, S. Thrun, "The dynamic window approach to collision avoidance",
IEEE RAM 4(1), 1997; obstacles at constant velocity as in M. Seder, I. Petrovic, "Dynamic window
based approach to mobile robot motion control in the presence of moving obstacles", ICRA 2007.
Path integral: G. Williams, A. Aldrich, E. Theodorou, "Model predictive path integral control: from
theory to parallel computation", J. Guidance, Control and Dynamics 40(2), 2017. Obstacles are
predicted at constant velocity; the sampled sequences obey the acceleration limits of the body.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap_array
from navigation.motion.planning_scene import Desired, PlanningScene
from navigation.motion.rollout import walked
from navigation.parameters.planner import DwaParameters, MppiParameters
from navigation.transform import velocity_in_world

Array = NDArray[np.float64]

_MIRROR = np.array([1.0, -1.0, -1.0])


class DynamicWindow:
    """Best body velocity among those within reach of the next footstep."""

    def __init__(self, parameters: DwaParameters) -> None:
        self._parameters = parameters

    def desired(self, scene: PlanningScene) -> Desired:
        s, p = scene, self._parameters
        limits = s.limits
        window = self._window(s)
        steps = max(1, round(p.horizon / limits.footstep))
        constant = np.repeat(window[:, None], steps, axis=1)
        position, heading = rollout(s.pose, constant, limits.footstep)
        horizon = steps * limits.footstep
        # A point ahead at the desired speed: the horizon may reach beyond the destination.
        error = position[:, -1] - (s.pose[:2] + horizon * s.to_goal())
        gap = gaps(position, s, s.radii(p.margin), p.clearance)
        facing = s.course if s.facing is None else s.facing
        wz = window[:, 2]
        stopping = 0.5 * wz * np.abs(wz) / s.turn_change * limits.footstep
        heading_error = np.abs(wrap_array(facing - heading[:, 0] - stopping))
        cost = (
            np.hypot(error[:, 0], error[:, 1]) / (horizon * limits.vx)
            + p.heading_weight * heading_error / np.pi
            + p.clearance_weight * np.maximum(0.0, 1.0 - gap.min(axis=1) / p.clearance)
            + p.contact_weight * contact_cost(gap)
        )
        return _turning(window[int(np.argmin(cost))], s, p.margin)

    def _window(self, s: PlanningScene) -> Array:
        """Return velocities within reach (n, 3), with zero components where possible."""
        low, high, change = s.low(), s.high(), s.change()
        low, high = np.maximum(low, s.body - change), np.minimum(high, s.body + change)
        axes = [
            np.linspace(a, b, n)
            for a, b, n in zip(low, high, self._parameters.samples, strict=True)
        ]
        axes = [np.sort(np.append(axis, np.clip(0.0, axis[0], axis[-1]))) for axis in axes]
        grid = np.meshgrid(*axes, indexing="ij")
        window: Array = np.stack([g.ravel() for g in grid], axis=1)
        return window


class PathIntegral:
    """Mean of sampled sequences of footsteps, weighted by the exponential of their cost."""

    def __init__(self, parameters: MppiParameters, rng: np.random.Generator) -> None:
        """Take the generator `rng` of the samples."""
        self._parameters = parameters
        self._rng = rng
        lag = np.arange(parameters.steps)
        rho = parameters.persistence
        power = rho ** np.maximum(0, lag[:, None] - lag)
        drive = np.where(lag == 0, 1.0, np.sqrt(1.0 - rho**2))
        self._correlation = np.tril(power) * drive

    def desired(self, scene: PlanningScene) -> Desired:
        s, p = scene, self._parameters
        plan = s.plan if isinstance(s.plan, np.ndarray) else np.zeros((p.steps, 3))
        body = self._samples(s, plan)
        cost = self._cost(s, body)
        weight = np.exp(-(cost - cost.min()) / p.temperature)
        mean = np.einsum("k,kti->ti", weight / weight.sum(), body)
        return _turning(mean[0], s, p.margin, np.concatenate([mean[1:], mean[-1:]]))

    def _samples(self, s: PlanningScene, plan: Array) -> Array:
        """Return samples around the plan (k, t, 3), mirrored in pairs, the plan and zeros."""
        p = self._parameters
        low, high, change = s.low(), s.high(), s.change()
        white = self._rng.standard_normal((p.samples // 2, p.steps, 3))
        noise = p.spread * high * np.einsum("ts,ksi->kti", self._correlation, white)
        zeros = np.zeros((1, p.steps, 3))
        mirrored = plan + _MIRROR * noise
        samples = np.concatenate([plan + noise, mirrored, plan[None], zeros])
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
        gap = gaps(position, s, s.radii(p.margin), p.clearance)
        cost: Array = (
            distance.mean(axis=1) / walked
            + p.heading_weight * heading_error.mean(axis=1) / np.pi
            + p.clearance_weight * np.maximum(0.0, 1.0 - gap / p.clearance).mean(axis=1)
            + p.contact_weight * contact_cost(gap)
        )
        return cost


def _turning(body: Array, s: PlanningScene, margin: float, plan: Array | None = None) -> Desired:
    """Return the motion of a method that decides the turn rate, too."""
    velocity = velocity_in_world(s.pose, np.clip(body, s.low(), s.high()))
    towards = Desired.towards(velocity, s, s.radii(margin))
    return replace(towards, body=body, plan=plan)


def rollout(pose: Array, body: Array, footstep: float) -> tuple[Array, Array]:
    """Integrate body velocities, each over one footstep.

    Args:
        pose: start (3,) [m, m, rad].
        body: vx, vy, wz of k sequences of t footsteps (k, t, 3) [m/s, m/s, rad/s].
        footstep: duration of a footstep [s].

    Returns:
        Positions after each footstep (k, t, 2) [m] and headings (k, t) [rad].
    """
    velocity, heading = walked(body, float(pose[2]), footstep)
    position: Array = pose[:2] + footstep * np.cumsum(velocity, axis=1)
    return position, heading


def gaps(position: Array, scene: PlanningScene, radii: Array, max_gap: float) -> Array:
    """Return the gap to the nearest obstacle after every footstep (k, t) [m].

    Args:
        position: positions of k sequences of t footsteps (k, t, 2) [m].
        scene: obstacles, which continue at constant velocity.
        radii: collision distances of the obstacles (n,) [m].
        max_gap: upper bound of the gap [m].
    """
    k, t, _ = position.shape
    limits, obstacles = scene.limits, scene.obstacles
    dt = limits.footstep
    offset = obstacles.position - scene.pose[:2]
    reach = t * dt * (obstacles.speed + limits.max_speed) + radii + max_gap
    near = np.nonzero(np.hypot(offset[:, 0], offset[:, 1]) < reach)[0].tolist()
    nearest = np.full((k, t), max_gap)
    time = dt * np.arange(1, t + 1)
    for index in near:
        x, y = obstacles.position[index].tolist()
        u, w = obstacles.velocity[index].tolist()
        dx = position[..., 0] - (x + u * time)
        dy = position[..., 1] - (y + w * time)
        np.minimum(nearest, np.sqrt(dx * dx + dy * dy) - radii[index], out=nearest)
    return nearest


def contact_cost(gap: Array) -> Array:
    """Return 1 for a collision after the first footstep, less for later ones, 0 for none (k,).

    The depth of the first footstep in an obstacle [m] is added.
    """
    collides = gap < 0.0
    t = gap.shape[1]
    first = np.where(collides.any(axis=1), collides.argmax(axis=1), t)
    cost: Array = 1.0 - first / t + np.maximum(0.0, -gap[:, 0])
    return cost
