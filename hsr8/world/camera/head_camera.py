"""Head camera of a run: its source, its faults, and the timing of its frames."""

from functools import partial

import mujoco

from hsr8.scenario.schema import Scenario
from hsr8.seeds import named_rng
from hsr8.world.body.body import Body
from hsr8.world.camera.analytic import AnalyticCamera
from hsr8.world.camera.feed import CameraFaults, CameraFeed, CapturedFrame
from hsr8.world.camera.rendered import RenderedCamera
from hsr8.world.field.layout import Layout
from navigation.observation import CameraModel


class HeadCamera:
    """Head camera of a scenario; a rendered one captures between `open` and `close`.

    Args:
        scenario: what to run.
        model: compiled world.
        layout: obstacles and beacons.
        constants: field of view and visibility of obstacles, for a camera without pixels.
        seed: seed of the run.
    """

    def __init__(
        self,
        scenario: Scenario,
        model: mujoco.MjModel,
        layout: Layout,
        constants: CameraModel,
        seed: int,
    ) -> None:
        settings, faults = scenario.camera, CameraFaults(scenario.fault)
        rng = named_rng(seed, "camera")
        self._feed = CameraFeed(settings, named_rng(seed, "camera_feed"), faults)
        self._render = partial(RenderedCamera, model, settings, rng, faults)
        self._rendered: RenderedCamera | None = None
        self._analytic: AnalyticCamera | None = None
        if settings.source != "rendered":
            self._analytic = AnalyticCamera(layout, settings, constants, rng, faults)

    def open(self) -> None:
        """Prepare rendering.

        Raises:
            RenderingUnavailable: OpenGL cannot render here.
        """
        if self._analytic is None:
            self._rendered = self._render()

    def close(self) -> None:
        """Free OpenGL."""
        if self._rendered is not None:
            self._rendered.close()

    def shutter(self, tick: int) -> bool:
        """Return whether a frame is captured in control tick `tick`."""
        return self._feed.shutter(tick)

    def arrived(self, tick: int, body: Body) -> CapturedFrame | None:
        """Return the frame that arrives in control tick `tick`, if any, after a due capture."""
        return self._feed.arrived(tick, partial(self._capture, body))

    def _capture(self, body: Body) -> CapturedFrame:
        """Capture the present world."""
        if self._analytic is not None:
            return CapturedFrame(body.time, detections=self._analytic.capture(body))
        assert self._rendered is not None
        return CapturedFrame(body.time, self._rendered.capture(body))
