"""Camera faults in force at any time."""

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
    """Magnitudes of the camera faults; it draws no random numbers.

    Args:
        faults: of the scenario; faults of other parts are ignored.
    """

    def __init__(self, faults: Sequence[Fault] = ()) -> None:
        self._black = [f for f in faults if isinstance(f, CameraBlack)]
        self._light = [f for f in faults if isinstance(f, Lighting)]
        self._drops = [f for f in faults if isinstance(f, CameraDrops)]
        self._misses = [f for f in faults if isinstance(f, MissedDetections)]
        self._false = [f for f in faults if isinstance(f, FalseDetections)]
        self._latency = [f for f in faults if isinstance(f, CameraLatency)]

    def black(self, tick: int) -> bool:
        """Return whether an image captured in control tick `tick` is black."""
        return any(f.acts(tick) for f in self._black)

    def light(self, tick: int) -> float:
        """Return the brightness relative to world.brightness."""
        return prod((f.magnitude for f in self._light if f.acts(tick)), start=1.0)

    def dropped(self, tick: int) -> float:
        """Return the probability that an image never arrives."""
        return 1.0 - prod((1.0 - f.magnitude for f in self._drops if f.acts(tick)), start=1.0)

    def missed(self, tick: int) -> float:
        """Return the probability that an object is not in the image."""
        return 1.0 - prod((1.0 - f.magnitude for f in self._misses if f.acts(tick)), start=1.0)

    def false_detections(self, tick: int) -> float:
        """Return the mean number of false detections per image."""
        return sum((f.magnitude for f in self._false if f.acts(tick)), start=0.0)

    def latency(self, tick: int) -> int:
        """Return the additional latency of an image in control ticks."""
        return sum(ticks(f.magnitude) for f in self._latency if f.acts(tick))
