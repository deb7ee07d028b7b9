"""Faults of the head camera at any time."""

from collections.abc import Sequence
from math import prod

from hsr8.scenario.fault import (
    CameraBlack,
    CameraDrops,
    CameraLatency,
    FalseDetections,
    Fault,
    Lighting,
    MissedDetections,
    ticks,
)


class CameraFaults:
    """What is wrong with the images; it draws nothing itself.

    Args:
        faults: of the scenario; those of other parts are left to them.
    """

    def __init__(self, faults: Sequence[Fault] = ()) -> None:
        self._black = [f for f in faults if isinstance(f, CameraBlack)]
        self._light = [f for f in faults if isinstance(f, Lighting)]
        self._drops = [f for f in faults if isinstance(f, CameraDrops)]
        self._misses = [f for f in faults if isinstance(f, MissedDetections)]
        self._ghosts = [f for f in faults if isinstance(f, FalseDetections)]
        self._late = [f for f in faults if isinstance(f, CameraLatency)]

    def black(self, tick: int) -> bool:
        """Whether an image taken in control tick `tick` is black."""
        return any(f.acts(tick) for f in self._black)

    def light(self, tick: int) -> float:
        """Strength of the lights, relative to world.brightness."""
        return prod((f.magnitude for f in self._light if f.acts(tick)), start=1.0)

    def dropped(self, tick: int) -> float:
        """Probability that an image never arrives."""
        return 1.0 - prod((1.0 - f.magnitude for f in self._drops if f.acts(tick)), start=1.0)

    def missed(self, tick: int) -> float:
        """Probability that a thing is not shown."""
        return 1.0 - prod((1.0 - f.magnitude for f in self._misses if f.acts(tick)), start=1.0)

    def ghosts(self, tick: int) -> float:
        """Mean number of things that an image shows though they are not there."""
        return sum((f.magnitude for f in self._ghosts if f.acts(tick)), start=0.0)

    def late(self, tick: int) -> int:
        """By how many control ticks an image arrives later than usual."""
        return sum(ticks(f.magnitude) for f in self._late if f.acts(tick))
