"""Safety filter: a veto on velocities that lead to a collision.

The desired velocity passes if it is safe. If not, the best of a fan of velocities replaces it: all
are rolled out as footsteps within the limits of the body, and their losses are added, all in
seconds: the delay, collisions by time and probability, close passages, and changes of
velocity.
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
    """Veto of velocities that lead to a collision, and the choice of another one.

    Args:
        parameters: horizons and losses.
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
        self._record = record(parameters)
        self._limits = limits
        self._envelope = envelope(limits, mapping.turn_gain)
        self._gait = (limits.footstep, limits.acceleration * limits.footstep, p.turn_change)
        self._steps = round(p.moving_horizon / limits.footstep)
        self._turns = np.repeat(2.0 * pi * np.arange(p.headings) / p.headings, p.speeds)
        self._speeds = np.tile(limits.vx * np.arange(1, p.speeds + 1) / p.speeds, p.headings)

    def choose(
        self, start: RolloutStart, desired: Array, discs: NDArray[np.record]
    ) -> tuple[Array, float]:
        """Return the best velocity in W (2,) [m/s], `desired` if safe, and its direction [rad].

        Args:
            start: start of the rollout.
            desired: desired velocity in W (2,) [m/s].
            discs: collision hypotheses, records of type `Disc` (m,).
        """
        near = within_reach(discs, start.pose[:2], self._limits.vx)
        if len(near) == 0 or self.risk(start, desired[None], near)[0] == 0.0:
            return desired, start.course
        candidates = self.candidates(desired, start.course)
        loss = self.risk(start, candidates, near) + self.delay(start, candidates)
        best = int(np.argmin(loss))
        if best == 0:
            return desired, start.course
        vx, vy = candidates[best].tolist()
        return candidates[best], atan2(vy, vx) if hypot(vx, vy) > 1e-9 else start.course

    def candidates(self, desired: Array, course: float) -> Array:
        """Return `desired`, zero, and a fan of directions and speeds (n, 2) [m/s]."""
        angles = course + self._turns
        fan = self._speeds[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        return np.concatenate([desired[None], np.zeros((1, 2)), fan])

    def delay(self, start: RolloutStart, candidates: Array) -> Array:
        """Return the losses by delay and by change of velocity (n,) [s].

        The delay is the distance from the point that the first candidate reaches within the
        horizon, over the maximum speed.
        """
        p, limits = self._parameters, self._limits
        horizon = self._steps * limits.footstep
        error = candidates - candidates[0]
        change = candidates - velocity_in_world(start.pose, start.body)
        lost = horizon * np.hypot(error[:, 0], error[:, 1])
        lost += p.change_loss * np.hypot(change[:, 0], change[:, 1])
        delay: Array = lost / limits.vx
        return delay

    def risk(self, start: RolloutStart, candidates: Array, discs: NDArray[np.record]) -> Array:
        """Return the losses by collisions and close passages of every candidate (n,) [s]."""
        position, footstep = start.pose[:2], self._limits.footstep
        velocity, _ = rollout.walked(
            self.rollout(start, candidates), float(start.pose[2]), footstep
        )
        contacts = rollout.contact_times(velocity, footstep, position, discs)
        return rollout.losses(contacts, position, discs, self._limits.vx, self._record)

    def rollout(self, start: RolloutStart, candidates: Array) -> Array:
        """Return the body velocities of every candidate (n, steps, 3) [m/s, m/s, rad/s]."""
        return rollout.followed(
            candidates,
            float(start.pose[2]),
            start.course,
            nan if start.facing is None else start.facing,
            start.body,
            self._envelope,
            self._gait,
            self._steps,
        )
