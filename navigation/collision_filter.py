"""Time-to-contact filter: the best of many velocities, rolled out over real footsteps.

The robot cannot turn on the spot in no time, so a velocity is not judged by its straight
line alone: each candidate is first walked for some footsteps with the body's own motion,
then turns as long as it must, then goes straight.
"""

from dataclasses import dataclass
from math import atan2, hypot, isfinite, pi

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap_array
from navigation.body_command import body_velocity
from navigation.decision import SpeedLimits
from navigation.decision_parameters import BodyParameters, FilterParameters
from navigation.hypotheses import Hypotheses

Array = NDArray[np.float64]

_INSIDE = 10.0
_INSIDE_DEPTH = 40.0
_INSIDE_CLOSING = 100.0
_SIDE_STEP = 1.2
"""Speeds below this multiple of the lateral limit need no turn first."""


@dataclass(frozen=True, slots=True)
class Paths:
    """n piecewise straight paths of k pieces from one point.

    Attributes:
        velocity: of each piece (k, n, 2) [m/s].
        duration: of each piece (k, n) [s]; the last may be infinite.
    """

    velocity: Array
    duration: Array


def contact_times(paths: Paths, position: Array, discs: Hypotheses) -> tuple[Array, Array]:
    """Time to first contact of every path with every disc.

    Inside a disc it is zero if closing, and nothing if leaving.

    Args:
        paths: of the robot.
        position: where they start (2,) [m].
        discs: m discs at constant velocity.

    Returns:
        Time to contact (n, m) [s], infinite for none; closing speed at the start (n, m), of
        discs out of reach of the first piece zero [m/s].
    """
    k, n = paths.duration.shape
    first = np.full((n, len(discs)), np.inf)
    closing = np.zeros_like(first)
    offset = discs.position - position
    gap = np.hypot(offset[:, 0], offset[:, 1]) - discs.radius
    speed = np.hypot(discs.velocity[:, 0], discs.velocity[:, 1])
    moved, start, fastest = np.zeros((n, 2)), np.zeros(n), 0.0
    for piece in range(k):
        velocity, duration = paths.velocity[piece], paths.duration[piece]
        end = start + duration
        fastest = max(fastest, float(np.hypot(velocity[:, 0], velocity[:, 1]).max()))
        latest = float(end.max())
        # Only these can be touched by then.
        near = np.arange(len(discs))
        if isfinite(latest):
            near = np.nonzero(gap <= (speed + fastest) * latest)[0]
        u = discs.velocity[near, 0] - velocity[:, 0, None]
        w = discs.velocity[near, 1] - velocity[:, 1, None]
        dx = offset[near, 0] + start[:, None] * discs.velocity[near, 0] - moved[:, 0, None]
        dy = offset[near, 1] + start[:, None] * discs.velocity[near, 1] - moved[:, 1, None]
        rate = dx * u + dy * w
        outside = dx * dx + dy * dy - discs.radius[near] ** 2
        speed2 = u * u + w * w
        discriminant = rate * rate - speed2 * outside
        row, column = np.nonzero((rate < 0.0) & ((discriminant > 0.0) | (outside < 0.0)))
        root = np.sqrt(np.maximum(discriminant[row, column], 0.0))
        closest = -rate[row, column] - root
        time = np.maximum(0.0, closest / np.maximum(speed2[row, column], 1e-12))
        meets = time <= duration[row]
        row, column, time = row[meets], near[column[meets]], time[meets]
        first[row, column] = np.minimum(first[row, column], start[row] + time)
        if piece == 0:
            distance = np.hypot(offset[near, 0], offset[near, 1])
            closing[:, near] = np.maximum(0.0, -rate / np.maximum(distance, 1e-6))
        if piece < k - 1:
            moved = moved + duration[:, None] * velocity
            start = end
    return first, closing


class CollisionFilter:
    """Chooses among many velocities the one that costs least and touches nothing soon."""

    def __init__(
        self, parameters: FilterParameters, body: BodyParameters, limits: SpeedLimits
    ) -> None:
        """Prepare the candidates.

        Args:
            parameters: horizons and penalties.
            body: mapping to the body.
            limits: envelope of the walking layer.
        """
        self._parameters = parameters
        self._body = body
        self._limits = limits
        turns = 2.0 * pi * np.arange(parameters.headings) / parameters.headings
        speeds = limits.forward * np.arange(1, parameters.speeds + 1) / parameters.speeds
        self._turns = np.repeat(turns, parameters.speeds)
        self._speeds = np.tile(speeds, parameters.headings)

    def choose(
        self,
        pose: Array,
        wanted: Array,
        course: float,
        *,
        facing: float | None,
        body_now: Array,
        discs: Hypotheses,
    ) -> Array:
        """Velocity in W to walk with (2,) [m/s].

        Args:
            pose: of the robot (3,) [m, m, rad].
            wanted: velocity asked for in W (2,) [m/s].
            course: its direction, also when it is zero [rad].
            facing: heading to turn to; None for the direction of motion [rad].
            body_now: present velocity of the body in R (3,) [m/s, m/s, rad/s].
            discs: what not to touch.
        """
        near = discs.within_reach(pose[:2], self._limits.forward)
        if len(near) == 0:
            return wanted
        candidates = self.candidates(wanted, course)
        penalty = self.penalty(
            pose, candidates, course, facing=facing, body_now=body_now, discs=near
        )
        c, s = np.cos(pose[2]), np.sin(pose[2])
        now = np.array([c * body_now[0] - s * body_now[1], s * body_now[0] + c * body_now[1]])
        off, change = candidates - wanted, candidates - now
        cost = (
            np.hypot(off[:, 0], off[:, 1])
            + self._parameters.change_weight * np.hypot(change[:, 0], change[:, 1])
        ) / self._limits.forward + penalty
        best: Array = candidates[int(np.argmin(cost))]
        return best

    def candidates(self, wanted: Array, course: float) -> Array:
        """The wanted velocity, standing, and a fan of directions and speeds (n, 2) [m/s]."""
        angles = course + self._turns
        fan = self._speeds[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        return np.concatenate([wanted[None], np.zeros((1, 2)), fan])

    def penalty(
        self,
        pose: Array,
        candidates: Array,
        course: float,
        *,
        facing: float | None,
        body_now: Array,
        discs: Hypotheses,
    ) -> Array:
        """Penalty for contacts of every candidate (n,); arguments as for `choose`."""
        p = self._parameters
        paths = self.paths(pose, candidates, course, facing, body_now)
        time, closing = contact_times(paths, pose[:2], discs)
        offset = discs.position - pose[:2]
        depth = 1.0 - np.hypot(offset[:, 0], offset[:, 1]) / discs.radius
        weight = np.where(time < p.urgent_time, p.urgent_weight, p.weight)
        cost = np.maximum(0.0, 1.0 - time / discs.horizon) * weight
        inside = (depth > 0.0) & (time < discs.horizon)
        cost += inside * (_INSIDE + _INSIDE_DEPTH * depth + _INSIDE_CLOSING * closing)
        total: Array = cost @ discs.weight
        return total

    def paths(
        self, pose: Array, candidates: Array, course: float, facing: float | None, body_now: Array
    ) -> Paths:
        """Where the body would really go, footstep by footstep, for every candidate."""
        p, limits = self._parameters, self._limits
        n = len(candidates)
        speed = np.hypot(candidates[:, 0], candidates[:, 1])
        standing = speed < 1e-9
        direction = np.where(standing, course, np.arctan2(candidates[:, 1], candidates[:, 0]))
        facing_to = direction if facing is None else np.full(n, facing)
        heading = np.full(n, float(pose[2]))
        body = np.broadcast_to(np.asarray(body_now, dtype=np.float64), (n, 3))
        change = limits.acceleration * limits.footstep
        velocity = np.empty((p.steps + 2, n, 2))
        duration = np.full((p.steps + 2, n), limits.footstep)
        for step in range(p.steps):
            goal = body_velocity(
                direction, speed, heading, facing_to, limits=limits, turn_gain=self._body.turn_gain
            )
            delta = goal - body
            size = np.hypot(delta[:, 0], delta[:, 1])
            delta[:, :2] *= np.minimum(1.0, change / np.maximum(size, 1e-9))[:, None]
            np.clip(delta[:, 2], -p.turn_change, p.turn_change, out=delta[:, 2])
            body = body + delta
            middle = heading + 0.5 * body[:, 2] * limits.footstep
            c, s = np.cos(middle), np.sin(middle)
            velocity[step, :, 0] = c * body[:, 0] - s * body[:, 1]
            velocity[step, :, 1] = s * body[:, 0] + c * body[:, 1]
            heading = heading + body[:, 2] * limits.footstep
        error = np.abs(wrap_array(direction - heading))
        wait = np.maximum(0.0, error - self._body.turn_wait) / limits.turn
        velocity[p.steps] = 0.0
        duration[p.steps] = np.where(speed > _SIDE_STEP * limits.lateral, wait, 0.0)
        velocity[p.steps + 1] = candidates
        duration[p.steps + 1] = np.inf
        return Paths(velocity, duration)


def direction_and_speed(velocity: Array, fallback: float) -> tuple[float, float]:
    """Direction [rad] and norm [m/s] of `velocity` (2,); `fallback` if it is zero."""
    x, y = velocity.tolist()
    speed = hypot(x, y)
    return (atan2(y, x) if speed > 1e-9 else fallback), speed
