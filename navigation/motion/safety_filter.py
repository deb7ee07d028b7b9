"""Safety filter: the best of many candidate velocities by the time to collision of a rollout.

The rollout of a candidate starts with some footsteps within the acceleration limits of the body,
then turns towards the direction of motion if necessary, then continues straight.
"""

from math import atan2, hypot, nan, pi

import numpy as np
from numpy.typing import NDArray

from compilation.record import record
from compilation.value import value
from navigation.decision import SpeedLimits
from navigation.motion import rollout
from navigation.motion.hypotheses import within_reach
from navigation.motion.velocity_mapping import envelope
from navigation.parameters.motion import SafetyFilterParameters, VelocityMappingParameters
from navigation.transform import velocity_in_world

Array = NDArray[np.float64]


@value
class RolloutStart:
    """Start of a rollout.

    Attributes:
        pose: pose of the robot (3,) [m, m, rad].
        body: present velocity in R, vx, vy, wz (3,) [m/s, m/s, rad/s].
        course: direction of motion in W, defined also for zero velocity [rad].
        facing: target heading of the body; None for the direction of motion [rad].
    """

    pose: Array
    body: Array
    course: float
    facing: float | None


class SafetyFilter:
    """Choice of the candidate velocity with minimum cost.

    Args:
        parameters: horizons and penalties.
        mapping: velocity mapping.
        limits: speed limits of the walking layer.
    """

    def __init__(
        self,
        parameters: SafetyFilterParameters,
        mapping: VelocityMappingParameters,
        limits: SpeedLimits,
    ) -> None:
        p = self._parameters = parameters
        self._penalties = record(parameters)
        self._limits = limits
        self._envelope = envelope(limits, mapping.turn_gain)
        self._gait = (
            limits.footstep,
            limits.acceleration * limits.footstep,
            p.turn_change,
            mapping.turn_first_angle,
            mapping.sidestep_ratio * limits.vy,
        )
        self._turns = np.repeat(2.0 * pi * np.arange(p.headings) / p.headings, p.speeds)
        self._speeds = np.tile(limits.vx * np.arange(1, p.speeds + 1) / p.speeds, p.headings)

    def choose(
        self, start: RolloutStart, wanted: Array, discs: NDArray[np.record]
    ) -> tuple[float, float]:
        """Return direction in W [rad] and speed [m/s] of the best candidate.

        Args:
            start: start of the rollout.
            wanted: desired velocity in W (2,) [m/s].
            discs: collision hypotheses, records of type `DISC` (m,).
        """
        near = within_reach(discs, start.pose[:2], self._limits.vx)
        best = wanted
        if len(near) > 0:
            candidates = self.candidates(wanted, start.course)
            error = candidates - wanted
            change = candidates - velocity_in_world(start.pose, start.body)
            cost = (
                np.hypot(error[:, 0], error[:, 1])
                + self._parameters.change_weight * np.hypot(change[:, 0], change[:, 1])
            ) / self._limits.vx + self.penalty(start, candidates, near)
            best = candidates[int(np.argmin(cost))]
        vx, vy = best.tolist()
        speed = hypot(vx, vy)
        return (atan2(vy, vx) if speed > 1e-9 else start.course), speed

    def candidates(self, wanted: Array, course: float) -> Array:
        """Return `wanted`, zero, and a fan of directions and speeds (n, 2) [m/s]."""
        angles = course + self._turns
        fan = self._speeds[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        return np.concatenate([wanted[None], np.zeros((1, 2)), fan])

    def penalty(self, start: RolloutStart, candidates: Array, discs: NDArray[np.record]) -> Array:
        """Return the collision penalty of every candidate (n,)."""
        paths, position = self.rollout(start, candidates), start.pose[:2]
        contacts = rollout.contact_times(*paths, position, discs)
        return rollout.penalties(*contacts, position, discs, self._penalties)

    def rollout(self, start: RolloutStart, candidates: Array) -> tuple[Array, Array]:
        """Return velocities (k, n, 2) [m/s] and durations (k, n) [s] of the path segments."""
        return rollout.rollout(
            candidates,
            float(start.pose[2]),
            start.course,
            nan if start.facing is None else start.facing,
            start.body,
            self._envelope,
            self._gait,
            self._parameters.steps,
        )
