"""Pushes: external forces on the robot, scheduled or random."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, radians, sin

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.fault import Disturbance, Fault, Push
from hsr8.world.truth.truth import ActivePush

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ScheduledPush:
    """Push in whole control ticks.

    Attributes:
        first: first tick.
        ticks: duration [ticks].
        force: force on the body in W (3,) [N].
        direction: direction from the heading of the robot at the start, counter-clockwise [rad].
        body: name of the pushed body.
        point: point from the centre of mass of the body, along its axes [m].
    """

    first: int
    ticks: int
    force: float
    direction: float
    body: str
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)


def schedule(
    disturbance: Disturbance,
    duration: float,
    period: float,
    rng: np.random.Generator,
    faults: Sequence[Fault],
) -> tuple[ScheduledPush, ...]:
    """Return all pushes of a run, sorted by start.

    Args:
        disturbance: section of the scenario with random pushes.
        duration: duration of the run [s].
        period: control tick [s].
        rng: draws the random pushes.
        faults: faults of the scenario, possibly with pushes.
    """
    pushes = [_from_fault(fault, period) for fault in faults if isinstance(fault, Push)]
    drawn = disturbance.random
    time = drawn.start if drawn is not None else duration
    while drawn is not None and time < duration:
        ticks = _ticks(drawn.duration, period)
        force = float(rng.uniform(*drawn.impulse)) / (ticks * period)
        direction = radians(float(rng.uniform(*drawn.direction_deg)))
        pushes.append(ScheduledPush(round(time / period), ticks, force, direction, drawn.body))
        time += float(rng.uniform(*drawn.interval))
    return tuple(sorted(pushes, key=lambda push: push.first))


class Pusher:
    """Applies pushes to a model.

    Args:
        model: compiled world.
        pushes: sorted by start.
        period: control tick [s].
    """

    def __init__(
        self, model: mujoco.MjModel, pushes: Sequence[ScheduledPush], period: float
    ) -> None:
        self._pushes = pushes
        self._period = period
        self._bodies = [int(model.body(push.body).id) for push in pushes]
        self._next = 0
        self._acting: dict[int, Array] = {}
        self._applied: dict[int, ActivePush] = {}

    def active(self, tick: int) -> bool:
        """Return whether a push begins, lasts or ends in control tick `tick`."""
        due = self._next < len(self._pushes) and self._pushes[self._next].first <= tick
        return due or bool(self._acting)

    def apply(self, data: mujoco.MjData, tick: int, heading: float) -> None:
        """Set the external forces for control tick `tick`; `heading` of the robot in [rad]."""
        for number in self._acting:
            data.xfrc_applied[self._bodies[number]] = 0.0
        while self._next < len(self._pushes) and self._pushes[self._next].first <= tick:
            push = self._pushes[self._next]
            angle = heading + push.direction
            self._acting[self._next] = push.force * np.array([cos(angle), sin(angle), 0.0])
            self._next += 1
        for number in list(self._acting):
            push = self._pushes[number]
            if tick >= push.first + push.ticks:
                del self._acting[number]
        for number, force in self._acting.items():
            push, body = self._pushes[number], self._bodies[number]
            lever = data.xmat[body].reshape(3, 3) @ push.point
            data.xfrc_applied[body, :3] += force
            data.xfrc_applied[body, 3:] += np.cross(lever, force)
            self._applied[number] = ActivePush(
                number=number,
                begin=push.first * self._period,
                duration=push.ticks * self._period,
                body=push.body,
                direction=push.direction,
                point=data.xipos[body] + lever,
                force=force,
            )

    def take(self) -> tuple[ActivePush, ...]:
        """Return and clear the pushes that acted since the last call, in order."""
        applied = tuple(self._applied[number] for number in sorted(self._applied))
        self._applied.clear()
        return applied


def _from_fault(fault: Push, period: float) -> ScheduledPush:
    ticks = _ticks(fault.duration, period)
    first, direction = round(fault.start / period), radians(fault.direction_deg)
    force = fault.magnitude / (ticks * period)
    return ScheduledPush(first, ticks, force, direction, fault.body, fault.point)


def _ticks(duration: float, period: float) -> int:
    return max(1, round(duration / period))
