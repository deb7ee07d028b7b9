"""Images of a run at given instants, from one camera or as a dashboard."""

from bisect import bisect_right
from collections.abc import Callable
from contextlib import ExitStack, closing
from types import SimpleNamespace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recording.run import Run
from hsr8.robots.loaded import load_robot
from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.robots.scale import DEFAULT_STATURE
from hsr8.robots.shown import stature
from hsr8.show.follow import FollowCamera
from hsr8.show.push_arrows import Arrow, PushArrow, push_arrows
from hsr8.show.scene_renderer import Image, SceneRenderer
from hsr8.show.video.camera_overlay import CameraOverlay
from hsr8.show.video.dashboard import Dashboard
from hsr8.show.video.top_down import TRAIL
from hsr8.world.field.generator import draw_layout
from hsr8.world.model.assembly import Optics, Quality
from walking.dimension import HSR_VIII

Array = NDArray[np.float64]
Draw = Callable[[int], Image]

CYCLE = 34  # records per gait cycle
OVERSAMPLING = {True: 2.0, False: 1.0}  # of fine and of quick images
CAMERA_OVERSAMPLING = 1.5  # of the head camera in the dashboard, which is small
COLUMNS = (  # of a drawn camera frame
    *("time", "captured", "pose", "pose_covariance", "lost", "head", "fov", "gaze", "psi"),
    *("target", "via_points", "velocity", "situation"),
    *(f"tracks.{c}" for c in ("id", "label", "position", "velocity", "covariance", "radius")),
    *("tracks.motion", "tracks.visible", "virtual_obstacles.position", "virtual_obstacles.radius"),
    *("detections.label", "detections.box", "detections.distance"),
)


class RunImages:
    """Renderer of a run at the instants of a video, used by ``with``.

    Args:
        run: recorded run.
        times: simulated time of each image (n,) [s].
        size: width and height [pixel].
        fps: images per second of the video.
        speed: simulated seconds per second of video, shown in the dashboard.
        fine: smooth edges and sharp shadows, at twice the cost.
    """

    def __init__(
        self, run: Run, times: Array, size: tuple[int, int], *, fps: int, speed: float, fine: bool
    ) -> None:
        self._scenario = run.scenario()
        self._layout = draw_layout(self._scenario, run.seed)
        self._robot = load_robot(self._scenario.robot.model)
        self._times, self._size, self._fine = times, size, fine
        self._fps, self._speed = fps, speed
        camera = self._scenario.camera
        self._optics = Optics(
            camera.width, camera.height, camera.vertical_fov, self._scenario.world.brightness
        )
        self._stack = ExitStack()
        self._records = run.records
        self._rows = run.records.at(times).tolist()
        self._frames = shown_frames(run, self._times)
        self._events = [*zip(run.events["time"].tolist(), run.events["kind"], strict=True)]
        self._event_times = [time for time, _ in self._events]
        self._pushes: tuple[PushArrow, ...] = ()
        size_ratio = stature(self._robot) / DEFAULT_STATURE
        if any(kind == "push" for _, kind in self._events):
            weight = self._robot.model.measures().weight / HSR_VIII.weight
            self._pushes = push_arrows(run.records, size_ratio, weight)
        qpos = run.records["qpos"][self._rows]
        self._follow = FollowCamera(qpos, self._fps, self._speed, size_ratio)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def camera(self, name: str) -> Draw:
        """Return a function that draws an image by its index.

        Args:
            name: ``dashboard``, ``follow``, ``head`` or a camera of the model.

        Raises:
            UsageError: unknown camera.
        """
        if name == "dashboard" and self._frames:
            return self._dashboard()
        if name == "head":
            return self._head()
        renderer = self._renderer("show", self._size)
        if name in ("dashboard", "follow"):
            return lambda i: self._draw_scene(renderer, i)
        renderer.require_camera(name)
        return lambda i: self._place(renderer, self._rows[i]).draw(name, self._arrows(i))

    def _renderer(
        self, quality: Quality, size: tuple[int, int], oversampling: float | None = None
    ) -> SceneRenderer:
        renderer = SceneRenderer(
            self._robot,
            self._layout,
            quality,
            size,
            optics=self._optics,
            oversampling=oversampling or OVERSAMPLING[self._fine],
            fine=self._fine,
        )
        self._stack.enter_context(closing(renderer))
        recorded = tuple(self._records[name].shape[1] for name in ("qpos", "obstacle_positions"))
        if recorded != (renderer.model.nq, len(self._layout.obstacles)):
            raise UsageError("the recorded motion does not match the scenario file of this run")
        return renderer

    def _place(self, renderer: SceneRenderer, row: int) -> SceneRenderer:
        """Put robot and movers where they are in a row of the motion."""
        columns = self._records["qpos"], self._records["obstacle_positions"]
        renderer.set_state(*(column[row] for column in columns))
        return renderer

    def _draw_scene(self, renderer: SceneRenderer, index: int) -> Image:
        placed = self._place(renderer, self._rows[index])
        return placed.draw(self._follow.at(index), self._arrows(index))

    def _draw_camera(self, renderer: SceneRenderer, frame: SimpleNamespace) -> Image:
        """Draw the image of the head camera at the capture of a frame."""
        (row,) = self._records.at([frame.captured]).tolist()
        return self._place(renderer, row).draw(HEAD_CAMERA)

    def _head(self) -> Draw:
        """Draw the image of the head camera, with the detections if the run has frames."""
        renderer = self._renderer("vision", self._size)
        if not self._frames:
            return lambda i: self._place(renderer, self._rows[i]).draw(HEAD_CAMERA)
        overlay = CameraOverlay(self._scenario.camera.pinhole, self._size)

        def draw(index: int) -> Image:
            frame = self._frames[index]
            image = self._draw_camera(renderer, frame)
            overlay.draw(image, frame)
            return image

        return draw

    def _dashboard(self) -> Draw:
        span = float(self._times[0]), float(self._times[-1])
        kinds = {kind for _, kind in self._events}
        board = Dashboard(self._layout, self._scenario, span, self._size, self._speed, kinds=kinds)
        movers = self._records["obstacle_positions"][:, len(self._layout.static) :]
        scene = self._renderer("show", board.scene_size)
        camera = self._renderer("vision", board.camera_size, CAMERA_OVERSAMPLING)
        latest: tuple[float, Image] | None = None  # one camera image per frame

        def camera_image(frame: SimpleNamespace) -> Image:
            nonlocal latest
            if latest is None or latest[0] != frame.captured:
                latest = frame.captured, self._draw_camera(camera, frame)
            return latest[1]

        def draw(index: int) -> Image:
            frame, row, time = self._frames[index], self._rows[index], float(self._times[index])
            return board.draw(
                self._draw_scene(scene, index),
                camera_image(frame),
                frame,
                time=time,
                movers=movers[row],
                trail=self._trail(row),
                events=self._events[: bisect_right(self._event_times, time)],
                state=self._state(index),
            )

        return draw

    def _state(self, index: int) -> str:
        """Return the situation of the robot in words."""
        frame, pushed = self._frames[index], self._pushed(index)
        if pushed:
            return f"push {pushed[-1].impulse:.2f} N s"
        return "lost" if frame.lost else str(frame.situation).replace("_", " ")

    def _pushed(self, index: int) -> list[PushArrow]:
        time = float(self._times[index])
        return [push for push in self._pushes if push.shown(time, self._speed)]

    def _arrows(self, index: int) -> list[Arrow]:
        base = self._records["qpos"][self._rows[index], :3]
        return [push.at(base) for push in self._pushed(index)]

    def _trail(self, row: int) -> Array:
        """Return the path up to a row, averaged over gait cycles to remove the sway (n, 2) [m]."""
        times = self._records["time"]
        first = int(np.searchsorted(times, times[row] - TRAIL))
        path = self._records["qpos"][first : row + 1, :2]
        whole = len(path) // CYCLE * CYCLE
        trail: Array = path[:whole].reshape(-1, CYCLE, 2).mean(axis=1)
        return trail


def shown_frames(run: Run, times: Array) -> tuple[SimpleNamespace, ...]:
    """Return the latest camera frame at each of the times (m,) [s]; empty if the run has none.

    The attributes of a frame are the columns `COLUMNS`, ``truth``, the true pose (3,)
    [m, m, rad], and ``gaze_map``, the latest gaze map in 255 shades, left and up of the head at
    left and up (tilts, pans), None without a map. Times with the same frame have the same object.
    """
    frames, records = run.frames, run.records
    if not len(frames):
        return ()
    rows, index = np.unique(frames.at(times), return_inverse=True)
    truth = records["robot"][records.at(frames["time"][rows])]
    made, maps = frames.present("gaze_map")
    latest = np.searchsorted(made, rows, side="right") - 1
    shown = frames.take(rows).objects(*COLUMNS)
    for frame, robot, k in zip(shown, truth.tolist(), latest.tolist(), strict=True):
        frame.truth = robot
        frame.gaze_map = maps[k][::-1, ::-1] if k >= 0 else None
    return tuple(shown[k] for k in index.tolist())
