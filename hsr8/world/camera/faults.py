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

Kind = type[CameraDrops | CameraLatency | FalseDetections | Lighting | MissedDetections]


class CameraFaults:
    """Magnitudes of the camera faults; it draws no random numbers.

    Args:
        faults: faults of the scenario; faults of other parts are ignored.
    """

    def __init__(self, faults: Sequence[Fault] = ()) -> None:
        self._faults = faults

    def black(self, tick: int) -> bool:
        """Return whether an image captured in control tick `tick` is black."""
        return any(isinstance(f, CameraBlack) and f.acts(tick) for f in self._faults)

    def light(self, tick: int) -> float:
        """Return the brightness relative to world.brightness."""
        return prod(self._magnitudes(Lighting, tick), start=1.0)

    def dropped(self, tick: int) -> float:
        """Return the probability that an image never arrives."""
        return 1.0 - prod((1.0 - m for m in self._magnitudes(CameraDrops, tick)), start=1.0)

    def missed(self, tick: int) -> float:
        """Return the probability that an object is not in the image."""
        return 1.0 - prod((1.0 - m for m in self._magnitudes(MissedDetections, tick)), start=1.0)

    def false_detections(self, tick: int) -> float:
        """Return the mean number of false detections per image."""
        return sum(self._magnitudes(FalseDetections, tick), start=0.0)

    def latency(self, tick: int) -> int:
        """Return the additional latency of an image in control ticks."""
        return sum(map(ticks, self._magnitudes(CameraLatency, tick)))

    def _magnitudes(self, kind: Kind, tick: int) -> list[float]:
        return [f.magnitude for f in self._faults if isinstance(f, kind) and f.acts(tick)]
