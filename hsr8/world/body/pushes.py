"""Pushes: when, how hard and where the world pushes the robot."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, radians, sin

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.disturbance import Disturbance
from hsr8.scenario.fault import Fault, Push
from hsr8.world.truth.truth import ActivePush

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ScheduledPush:
    """One push, in whole control ticks.

    Attributes:
        first: tick in which it begins.
        ticks: how many it lasts.
        force: [N].
        direction: from the robot's forward when it begins, counter-clockwise [rad].
        body: name of the pushed body.
        point: where, from the body's centre of mass, along its axes [m].
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
    """All pushes of a run in the order in which they begin.

    Args:
        disturbance: section of the scenario, which draws pushes.
        duration: of the run [s].
        period: control tick [s].
        rng: draws the random ones.
        faults: of the scenario, some of which are pushes.
    """
    pushes = [_of_fault(fault, period) for fault in faults if isinstance(fault, Push)]
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
        pushes: in the order in which they begin.
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
        self._seen: dict[int, ActivePush] = {}

    def busy(self, tick: int) -> bool:
        """Whether there is anything to do in control tick `tick`."""
        due = self._next < len(self._pushes) and self._pushes[self._next].first <= tick
        return due or bool(self._acting)

    def act(self, data: mujoco.MjData, tick: int, heading: float) -> None:
        """Set the forces of one control tick.

        Args:
            data: of the model.
            tick: about to be made.
            heading: of the robot [rad].
        """
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
            self._seen[number] = ActivePush(
                number=number,
                begin=push.first * self._period,
                duration=push.ticks * self._period,
                body=push.body,
                direction=push.direction,
                point=data.xipos[body] + lever,
                force=force,
            )

    def take(self) -> tuple[ActivePush, ...]:
        """Pushes that acted since the last call, in order; forgets them."""
        seen = tuple(self._seen[number] for number in sorted(self._seen))
        self._seen.clear()
        return seen


def _of_fault(fault: Push, period: float) -> ScheduledPush:
    ticks = _ticks(fault.duration, period)
    first, direction = round(fault.start / period), radians(fault.direction_deg)
    force = fault.magnitude / (ticks * period)
    return ScheduledPush(first, ticks, force, direction, fault.body, fault.point)


def _ticks(duration: float, period: float) -> int:
    return max(1, round(duration / period))
