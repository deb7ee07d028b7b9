"""Safety filter: the best of many candidate velocities by the time to collision of a rollout.

The rollout of a candidate starts with some footsteps within the acceleration limits of the body,
then turns towards the direction of motion if necessary, then continues straight.
"""

from math import atan2, hypot, nan, pi

import numpy as np
from numpy.typing import NDArray

from navigation.decision import SpeedLimits
from navigation.motion import rollout_kernel
from navigation.motion.facing import Facing
from navigation.motion.hypotheses import Hypotheses
from navigation.motion.velocity_mapping import envelope
from navigation.parameters.motion import SafetyFilterParameters, VelocityMappingParameters
from navigation.transform import velocity_in_world
from navigation.value import value

Array = NDArray[np.float64]


@value
class Paths:
    """n piecewise straight paths of k segments from one point.

    Attributes:
        velocity: of each segment (k, n, 2) [m/s].
        duration: of each segment (k, n) [s]; the last may be infinite.
    """

    velocity: Array
    duration: Array


def contact_times(paths: Paths, position: Array, discs: Hypotheses) -> tuple[Array, Array]:
    """Return time to collision and closing speed of every path with every disc.

    Args:
        paths: n paths of the robot.
        position: start of the paths (2,) [m].
        discs: m discs at constant velocity.

    Returns:
        As `rollout_kernel.contact_times`: (n, m) [s], (n, m) [m/s].
    """
    return rollout_kernel.contact_times(
        paths.velocity, paths.duration, position, discs.position, discs.velocity, discs.radius
    )


class SafetyFilter:
    """Choice of the candidate velocity with minimum cost."""

    def __init__(
        self,
        parameters: SafetyFilterParameters,
        body: VelocityMappingParameters,
        limits: SpeedLimits,
    ) -> None:
        """Prepare the candidates.

        Args:
            parameters: horizons and penalties.
            body: velocity mapping.
            limits: of the walking layer.
        """
        self._parameters = parameters
        self._body = body
        self._limits = limits
        turns = 2.0 * pi * np.arange(parameters.headings) / parameters.headings
        speeds = limits.vx * np.arange(1, parameters.speeds + 1) / parameters.speeds
        self._turns = np.repeat(turns, parameters.speeds)
        self._speeds = np.tile(speeds, parameters.headings)

    def choose(
        self,
        pose: Array,
        wanted: Array,
        course: float,
        *,
        facing: Facing,
        body_now: Array,
        discs: Hypotheses,
    ) -> Array:
        """Return the best velocity in W (2,) [m/s].

        Args:
            pose: of the robot (3,) [m, m, rad].
            wanted: desired velocity in W (2,) [m/s].
            course: direction of `wanted`, defined also if that is zero [rad].
            facing: target heading of the body.
            body_now: present velocity of the body in R (3,) [m/s, m/s, rad/s].
            discs: collision hypotheses.
        """
        near = discs.within_reach(pose[:2], self._limits.vx)
        if len(near) == 0:
            return wanted
        candidates = self.candidates(wanted, course)
        penalty = self.penalty(
            pose, candidates, course, facing=facing, body_now=body_now, discs=near
        )
        off, change = candidates - wanted, candidates - velocity_in_world(pose, body_now)
        cost = (
            np.hypot(off[:, 0], off[:, 1])
            + self._parameters.change_weight * np.hypot(change[:, 0], change[:, 1])
        ) / self._limits.vx + penalty
        best: Array = candidates[int(np.argmin(cost))]
        return best

    def candidates(self, wanted: Array, course: float) -> Array:
        """Return `wanted`, zero, and a fan of directions and speeds (n, 2) [m/s]."""
        angles = course + self._turns
        fan = self._speeds[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        return np.concatenate([wanted[None], np.zeros((1, 2)), fan])

    def penalty(
        self,
        pose: Array,
        candidates: Array,
        course: float,
        *,
        facing: Facing,
        body_now: Array,
        discs: Hypotheses,
    ) -> Array:
        """Return the collision penalty of every candidate (n,); arguments as for `choose`."""
        p = self._parameters
        paths = self.paths(pose, candidates, course, facing, body_now)
        time, closing = contact_times(paths, pose[:2], discs)
        offset = discs.position - pose[:2]
        depth = 1.0 - np.hypot(offset[:, 0], offset[:, 1]) / discs.radius
        return rollout_kernel.penalties(
            time,
            closing,
            depth,
            discs.horizon,
            discs.weight,
            (p.urgent_time, p.urgent_weight, p.weight),
            (p.inside_weight, p.inside_depth, p.inside_closing),
        )

    def paths(
        self, pose: Array, candidates: Array, course: float, facing: Facing, body_now: Array
    ) -> Paths:
        """Return the rollout of every candidate."""
        p, limits = self._parameters, self._limits
        velocity, duration = rollout_kernel.roll_out(
            candidates,
            float(pose[2]),
            course,
            nan if facing.heading is None else facing.heading,
            facing.offset,
            body_now,
            envelope(limits, self._body.turn_gain),
            (
                limits.footstep,
                limits.acceleration * limits.footstep,
                p.turn_change,
                self._body.turn_first_angle,
                self._body.sidestep_ratio * limits.vy,
            ),
            p.steps,
        )
        return Paths(velocity, duration)


def direction_and_speed(velocity: Array, fallback: float) -> tuple[float, float]:
    """Return direction [rad] and norm [m/s] of `velocity` (2,); `fallback` if it is zero."""
    x, y = velocity.tolist()
    speed = hypot(x, y)
    return (atan2(y, x) if speed > 1e-9 else fallback), speed
