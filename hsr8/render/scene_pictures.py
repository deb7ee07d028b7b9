"""Pictures of a run at given instants, from one camera or as a dashboard."""

from bisect import bisect_right
from collections.abc import Callable
from contextlib import ExitStack, closing
from math import hypot
from typing import Self

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.frame_summary import FrameSummary
from hsr8.recorder.run_reader import Run
from hsr8.recorder.trajectory import Trajectory, rows_at
from hsr8.render.follow import FollowCamera
from hsr8.render.push_arrows import SHOWN, Arrow, SeenPush, arrows_at, pushes_of
from hsr8.render.stage import Image, Stage
from hsr8.render.timeline import Timeline
from hsr8.render.top_down import TRAIL, TopDown
from hsr8.scenario.schema import Scenario
from hsr8.world.assembly import Optics, Quality
from hsr8.world.camera import HEAD_CAMERA
from hsr8.world.layout import Layout

Array = NDArray[np.float64]

CYCLE = 34  # records per gait cycle
BAR = 30  # height of the line of numbers [pixel]
INK, PANEL = (235, 236, 238), (34, 36, 40)
LABEL = 0.42  # size of the letters


class Pictures:
    """Draws the run at the instants of a video.

    Args:
        run: recorded run.
        scenario: its scenario.
        layout: its world.
        times: simulated time of each picture (n,) [s].
        size: width and height [pixel].
        fps: pictures per second when shown.
        speed: simulated seconds per second of video, shown in the dashboard.
        fine: smooth edges and sharp shadows, at four times the cost.
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
            float(np.radians(camera.vertical_fov_deg)),
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
            stage = self._stage("vision", self._size)
            return lambda i: self._placed(stage, i).draw(HEAD_CAMERA)
        stage = self._stage("show", self._size)
        stage.require_camera(name)
        return lambda i: self._placed(stage, i).draw(name, self._arrows(i))

    def _stage(self, quality: Quality, size: tuple[int, int]) -> Stage:
        stage = self._stack.enter_context(
            closing(Stage(self._layout, quality, size, optics=self._optics, fine=self._fine))
        )
        recorded = (self._trajectory.qpos.shape[1], self._trajectory.movers.shape[1])
        if recorded != (stage.model.nq, len(self._layout.movers)):
            raise UsageError(
                "the trajectory of this run belongs to another robot or scenario than its "
                "scenario file"
            )
        return stage

    def _placed(self, stage: Stage, index: int) -> Stage:
        row = int(self._rows[index])
        stage.place(self._trajectory.qpos[row], self._trajectory.movers[row])
        return stage

    def _dashboard(self) -> Callable[[int], Image]:
        width, height = self._size
        side = width // 3 // 2 * 2
        eye_height = min(side * 3 // 4, height // 2) // 2 * 2
        main = self._stage("show", (width - side, height))
        eye = self._stage("vision", (side, eye_height))
        above = TopDown(self._layout, (side, height - eye_height))
        first, last = float(self._times[0]), float(self._times[-1])
        timeline = Timeline(self._events, first, last, width - side)

        def draw(index: int) -> Image:
            frame = self._frame(index)
            picture = np.empty((height, width, 3), np.uint8)
            picture[:, : width - side] = self._placed(main, index).draw(
                self._follow.at(index), self._arrows(index)
            )
            picture[:eye_height, width - side :] = self._placed(eye, index).draw(HEAD_CAMERA)
            row = int(self._rows[index])
            picture[eye_height:, width - side :] = above.draw(
                frame, self._trajectory.movers[row], self._trail(row)
            )
            self._write_numbers(picture, index, frame, width - side)
            timeline.draw(picture[:, : width - side], float(self._times[index]))
            return picture

        return draw

    @staticmethod
    def _read_pushes(run: Run) -> tuple[SeenPush, ...]:
        """Runs of older versions did not tell how they walked, and had no pushes."""
        if not any(event["kind"] == "push" for event in run.events()):
            return ()
        return pushes_of(run.walking(), run.trajectory())

    def _arrows(self, index: int) -> list[Arrow]:
        base = self._trajectory.qpos[int(self._rows[index]), :3]
        return arrows_at(self._pushes, float(self._times[index]), base, self._speed)

    def _frame(self, index: int) -> FrameSummary:
        """The latest camera frame at a picture."""
        place = bisect_right(self._frame_times, float(self._times[index]) + 1e-9) - 1
        return self._frames[max(place, 0)]

    def _trail(self, row: int) -> Array:
        first = int(np.searchsorted(self._trajectory.time, self._trajectory.time[row] - TRAIL))
        path = self._trajectory.qpos[first : row + 1, :2]
        # The mean over a gait cycle shows the way without the sway.
        whole = len(path) // CYCLE * CYCLE
        trail: Array = path[:whole].reshape(-1, CYCLE, 2).mean(axis=1)
        return trail

    def _write_numbers(self, picture: Image, index: int, frame: FrameSummary, width: int) -> None:
        time = float(self._times[index])
        error = hypot(frame.pose[0] - frame.truth[0], frame.pose[1] - frame.truth[1])
        collisions = bisect_right(self._collisions, time)
        pushed = [p for p in self._pushes if 0.0 <= time - p.begin < SHOWN * self._speed]
        doing = "lost" if frame.lost else frame.situation.replace("_", " ")
        if pushed:
            doing = f"push {pushed[-1].impulse:.2f} N s"
        speed = f"  x{self._speed:g}" if self._speed != 1.0 else ""
        words = (
            f"{time:6.1f} s{speed}   via points {frame.passed}   collisions {collisions}   "
            f"{hypot(*frame.velocity[:2]):.2f} m/s   pose error {100 * error:4.1f} cm   "
            f"{doing}"
        )
        bar = picture[-BAR:, :width]
        bar[:] = (0.35 * bar + 0.65 * np.array(PANEL)).astype(np.uint8)
        scale = LABEL * min(1.0, width / 640)
        cv2.putText(
            picture,
            words,
            (10, picture.shape[0] - 10),
            cv2.FONT_HERSHEY_SIMPLEX,
            scale,
            INK,
            1,
            cv2.LINE_AA,
        )
