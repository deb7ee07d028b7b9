"""How images reach the robot: some never, the others after the camera's latency."""

from collections import deque
from collections.abc import Callable
from math import ceil

import numpy as np

from hsr8.scenario.camera import Camera
from hsr8.scenario.section import CONTROL_PERIOD_MS
from hsr8.world.camera.exposure import Exposure
from hsr8.world.camera.faults import CameraFaults
from vision.detection import Detection
from walking.value import value


@value
class Picture:
    """What the camera delivers.

    Attributes:
        captured: when it was taken [s].
        exposure: its image, or None of a camera without pixels.
        detections: what a camera without pixels reports instead.
    """

    captured: float
    exposure: Exposure | None = None
    detections: tuple[Detection, ...] | None = None


class CameraFeed:
    """Takes a picture every period and hands it over when it has arrived.

    Args:
        settings: period and latency.
        rng: generator of the dropped images.
        faults: images that are dropped, or late by whole periods; one that a newer one overtakes
            never arrives.
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
        self._under_way: deque[tuple[int, Picture]] = deque()

    def shutter(self, tick: int) -> bool:
        """Whether a picture is taken in control tick `tick`."""
        return tick % self._period == 0

    def arrived(self, tick: int, take: Callable[[], Picture]) -> Picture | None:
        """The picture that arrives in control tick `tick`, if any.

        Args:
            tick: control tick.
            take: takes a picture of the world as it is now; called if one is due.
        """
        if self.shutter(tick):
            picture = take()
            dropped = self._faults.dropped(tick)
            if not (dropped and self._rng.random() < dropped):
                late = ceil(self._faults.late(tick) / self._period) * self._period
                due = tick + self._latency + late
                while self._under_way and self._under_way[-1][0] >= due:
                    self._under_way.pop()  # the newer one overtakes it
                self._under_way.append((due, picture))
        if self._under_way and self._under_way[0][0] == tick:
            return self._under_way.popleft()[1]
        return None
