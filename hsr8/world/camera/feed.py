"""Camera feed: capture period, latency and dropped images."""

from collections import deque
from collections.abc import Callable
from math import ceil

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.section import CONTROL_PERIOD_MS
from hsr8.scenario.sensors import Camera
from hsr8.world.camera.faults import CameraFaults
from vision.detection import Detection
from walking.signals import value

Image = NDArray[np.uint8]


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
