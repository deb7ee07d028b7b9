"""RunImages of a run at given instants, from one camera or as a dashboard."""

from bisect import bisect_right
from collections.abc import Callable
from contextlib import ExitStack, closing
from typing import Self

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.run.frame_summary import FrameSummary
from hsr8.recorder.run.run_reader import Run
from hsr8.recorder.run.trajectory import Trajectory, rows_at
from hsr8.render.camera_overlay import CameraOverlay
from hsr8.render.dashboard import Dashboard, DashboardFrame
from hsr8.render.follow import FollowCamera
from hsr8.render.push_arrows import SHOWN, Arrow, SeenPush, arrows_at, pushes_of
from hsr8.render.scene_renderer import Image, SceneRenderer
from hsr8.render.timeline import Timeline
from hsr8.render.top_down import TRAIL
from hsr8.scenario.schema import Scenario
from hsr8.world.field.layout import Layout
from hsr8.world.model.assembly import HEAD_CAMERA, Optics, Quality

Array = NDArray[np.float64]

CYCLE = 34  # records per gait cycle
FINER = {True: 2.0, False: 1.0}  # fine and quick pictures are drawn so much finer than shown
SMALL = 1.5  # as is the head camera's view in the dashboard: it costs little


class RunImages:
    """Draws the run at the instants of a video.

    Args:
        run: recorded run.
        scenario: its scenario.
        layout: its world.
        times: simulated time of each picture (n,) [s].
        size: width and height [pixel].
        fps: pictures per second when shown.
        speed: simulated seconds per second of video, shown in the dashboard.
        fine: smooth edges and sharp shadows, at twice the cost.
    """

    def __init__(
        self,
        run: Run,
        scenario: Scenario,
        layout: Layout,
        *,
        times: Array,
        size: tuple[int, int],
        fps: int,
        speed: float,
        fine: bool,
    ) -> None:
        self._layout, self._size, self._speed = layout, size, speed
        self._scenario = scenario
        self._times = times
        self._trajectory: Trajectory = run.trajectory()
        self._rows = rows_at(self._trajectory.time, times)
        self._frames = run.frames()
        self._frame_times = [frame.time for frame in self._frames]
        self._events = run.events()
        self._collisions = [e["time"] for e in self._events if e["kind"] == "collision"]
        self._pushes = self._read_pushes(run)
        self._follow = FollowCamera(self._trajectory.qpos[self._rows], fps, speed)
        camera = scenario.camera
        self._optics = Optics(
            camera.width,
            camera.height,
            camera.vertical_fov,
            scenario.world.brightness,
        )
        self._fine = fine
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def camera(self, name: str) -> Callable[[int], Image]:
        """Drawer of pictures by index: ``dashboard``, ``follow``, ``head`` or a model camera.

        Raises:
            UsageError: there is no such camera.
        """
        if name == "dashboard" and self._frames:
            return self._dashboard()
        if name in ("dashboard", "follow"):
            stage = self._stage("show", self._size)
            return lambda i: self._placed(stage, i).draw(self._follow.at(i), self._arrows(i))
        if name == "head":
            return self._head()
        stage = self._stage("show", self._size)
        stage.require_camera(name)
        return lambda i: self._placed(stage, i).draw(name, self._arrows(i))

    def _stage(
        self, quality: Quality, size: tuple[int, int], finer: float | None = None
    ) -> SceneRenderer:
        stage = self._stack.enter_context(
            closing(
                SceneRenderer(
                    self._layout,
                    quality,
                    size,
                    optics=self._optics,
                    finer=FINER[self._fine] if finer is None else finer,
                    fine=self._fine,
                )
            )
        )
        recorded = (self._trajectory.qpos.shape[1], self._trajectory.movers.shape[1])
        if recorded != (stage.model.nq, len(self._layout.movers)):
            raise UsageError(
                "the trajectory of this run belongs to another robot or scenario than its "
                "scenario file"
            )
        return stage

    def _placed(self, stage: SceneRenderer, index: int) -> SceneRenderer:
        stage.place(*self._state(int(self._rows[index])))
        return stage

    def _state(self, row: int) -> tuple[Array, Array]:
        """Robot and movers in a row of the recording."""
        return self._trajectory.qpos[row], self._trajectory.movers[row]

    def _head(self) -> Callable[[int], Image]:
        """What the robot sees; with what it recognises there, where a run tells."""
        stage = self._stage("vision", self._size)
        if not self._frames:
            return lambda i: self._placed(stage, i).draw(HEAD_CAMERA)
        camera = self._scenario.camera
        overlay = CameraOverlay(
            (camera.width, camera.height), self._size, self._optics.vertical_fov
        )

        def draw(index: int) -> Image:
            frame = self._frames[self._frame(index)]
            stage.place(*self._state(int(rows_at(self._trajectory.time, [frame.captured])[0])))
            picture = stage.draw(HEAD_CAMERA)
            overlay.draw(picture, frame)
            return picture

        return draw

    def _dashboard(self) -> Callable[[int], Image]:
        first, last = float(self._times[0]), float(self._times[-1])
        timeline = Timeline(self._events, first, last)
        board = Dashboard(self._layout, self._scenario, timeline, self._size, self._speed)
        scene = self._stage("show", board.scene_size)
        eye = self._stage("vision", board.eye_size, SMALL)
        # The robot sees anew at every camera frame only, and the overlay belongs to that image.
        seen: tuple[int, Image] | None = None

        def look(number: int) -> Image:
            nonlocal seen
            if seen is None or seen[0] != number:
                captured = self._frames[number].captured
                eye.place(*self._state(int(rows_at(self._trajectory.time, [captured])[0])))
                seen = number, eye.draw(HEAD_CAMERA)
            return seen[1]

        def draw(index: int) -> Image:
            number = self._frame(index)
            outside = self._placed(scene, index).draw(self._follow.at(index), self._arrows(index))
            return board.draw(outside, look(number), self._moment(index, self._frames[number]))

        return draw

    def _moment(self, index: int, frame: FrameSummary) -> DashboardFrame:
        time, row = float(self._times[index]), int(self._rows[index])
        pushed = [p for p in self._pushes if 0.0 <= time - p.begin < SHOWN * self._speed]
        doing = "lost" if frame.lost else frame.situation.replace("_", " ")
        if pushed:
            doing = f"push {pushed[-1].impulse:.2f} N s"
        return DashboardFrame(
            time=time,
            frame=frame,
            movers=self._trajectory.movers[row],
            trail=self._trail(row),
            collisions=bisect_right(self._collisions, time),
            doing=doing,
        )

    @staticmethod
    def _read_pushes(run: Run) -> tuple[SeenPush, ...]:
        """Pushes of a run; how it walked is left unread where nothing pushed it."""
        if not any(event["kind"] == "push" for event in run.events()):
            return ()
        return pushes_of(run.walking(), run.trajectory())

    def _arrows(self, index: int) -> list[Arrow]:
        base = self._trajectory.qpos[int(self._rows[index]), :3]
        return arrows_at(self._pushes, float(self._times[index]), base, self._speed)

    def _frame(self, index: int) -> int:
        """Number of the latest camera frame at a picture."""
        return max(bisect_right(self._frame_times, float(self._times[index]) + 1e-9) - 1, 0)

    def _trail(self, row: int) -> Array:
        first = int(np.searchsorted(self._trajectory.time, self._trajectory.time[row] - TRAIL))
        path = self._trajectory.qpos[first : row + 1, :2]
        # The mean over a gait cycle shows the way without the sway.
        whole = len(path) // CYCLE * CYCLE
        trail: Array = path[:whole].reshape(-1, CYCLE, 2).mean(axis=1)
        return trail
