"""Camera feed: capture period, latency and dropped images, and the faults of the camera."""

from collections import deque
from collections.abc import Callable, Sequence
from math import ceil, prod

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
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
from hsr8.scenario.section import CONTROL_PERIOD_MS
from hsr8.scenario.sensors import Camera
from vision.detection import Detection

Image = NDArray[np.uint8]
Kind = type[CameraDrops | CameraLatency | FalseDetections | Lighting | MissedDetections]


@value
class CapturedFrame:
    """Camera frame: an image, or the detections of a camera without pixels.

    Attributes:
        captured: time of the capture [s].
        image: returns the image (height, width, 3) of a rendered camera, once it is complete.
        detections: detections of an analytic camera.
    """

    captured: float
    image: Callable[[], Image] | None = None
    detections: tuple[Detection, ...] | None = None


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


class CameraFeed:
    """Captures a frame every period and delivers it after the latency.

    Args:
        settings: period and latency.
        rng: draws dropped frames.
        faults: dropped frames and additional latency in whole periods; a frame that a newer one
            overtakes never arrives.
    """

    def __init__(
        self,
        settings: Camera,
        rng: np.random.Generator,
        faults: CameraFaults,
    ) -> None:
        self._rng = rng
        self._faults = faults
        self._period = settings.period_ms // CONTROL_PERIOD_MS
        self._latency = settings.latency_ms // CONTROL_PERIOD_MS
        self._pending: deque[tuple[int, CapturedFrame]] = deque()

    def shutter(self, tick: int) -> bool:
        """Return whether a frame is captured in control tick `tick`."""
        return tick % self._period == 0

    def arrived(self, tick: int, capture: Callable[[], CapturedFrame]) -> CapturedFrame | None:
        """Return the frame that arrives in control tick `tick`, if any.

        Args:
            tick: control tick.
            capture: captures the present world; called if a frame is due.
        """
        if self.shutter(tick):
            frame = capture()
            dropped = self._faults.dropped(tick)
            if not (dropped and self._rng.random() < dropped):
                late = ceil(self._faults.latency(tick) / self._period) * self._period
                due = tick + self._latency + late
                while self._pending and self._pending[-1][0] >= due:
                    self._pending.pop()  # overtaken
                self._pending.append((due, frame))
        if self._pending and self._pending[0][0] == tick:
            return self._pending.popleft()[1]
        return None
