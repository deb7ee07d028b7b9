"""A recorded run as a video or an image."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.files.atomic import draft
from hsr8.recording.run import Run
from hsr8.show.image import write_png
from hsr8.show.video.run_images import RunImages
from hsr8.show.video.video import VideoWriter

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]

SPEEDS = (1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 60.0)
LENGTH = 60.0  # the automatic speed limits videos to this length [s]


@dataclass(frozen=True, slots=True)
class VideoOptions:
    """Options of a video.

    Attributes:
        camera: ``dashboard``, ``follow``, ``head`` or a camera of the model.
        size: width and height, both even [pixel].
        fps: frames per second [1/s].
        start, stop: simulated time [s]; None is the end of the run.
        speed: simulated seconds per second of video; None for automatic.
        fine: smooth edges and sharp shadows, at twice the cost.
    """

    camera: str = "dashboard"
    size: tuple[int, int] = (960, 540)
    fps: int = 25
    start: float = 0.0
    stop: float | None = None
    speed: float | None = None
    fine: bool = False


@dataclass(frozen=True, slots=True)
class RenderedVideo:
    """Files and length of a rendered video.

    Attributes:
        video: file.
        thumbnail: image of the middle of the video; None without a video.
        frames: number of frames.
        duration: duration of the video [s].
        speed: simulated seconds per second of video.
    """

    video: Path
    thumbnail: Path | None
    frames: int
    duration: float
    speed: float


def render_run(run: Run, options: VideoOptions, out: Path, progress: Progress) -> RenderedVideo:
    """Draw a run as a video or an image, depending on the suffix of `out`.

    Args:
        run: recorded run.
        options: options of the video; an image shows the instant `start`.
        out: file to write: ``.mp4``, ``.webp`` or ``.png``. The thumbnail of an MP4
            file has the same name with the suffix ``.png``.
        progress: called with the number of finished frames and of all.

    Raises:
        OSError: a file cannot be written.
        UsageError: the run has no motion in the given time, or the camera is unknown.
        RenderingUnavailable: there is no OpenGL.
    """
    times, speed = instants(run.records["time"], options)
    suffix = out.suffix.lower()
    still = suffix == ".png"
    if still:
        times, speed = times[:1], 1.0
    count, thumbnail = len(times), None
    with RunImages(
        run, times, options.size, fps=options.fps, speed=speed, fine=options.fine
    ) as images:
        draw = images.camera(options.camera)
        if still:
            write_png(out, draw(0))
            progress(1, 1)
            return RenderedVideo(out, None, 1, 1 / options.fps, speed)
        with draft(out) as file, VideoWriter(file, options.size, options.fps) as video:
            for index in range(count):
                video.add(draw(index))
                progress(index + 1, count)
        if suffix == ".mp4":
            thumbnail = out.with_suffix(".png")
            write_png(thumbnail, draw(count // 2))
    return RenderedVideo(out, thumbnail, count, count / options.fps, speed)


def instants(time: Array, options: VideoOptions) -> tuple[Array, float]:
    """Return the simulated time of every frame (n,) [s] and the speed.

    Raises:
        UsageError: nothing was recorded between start and stop.
    """
    end = float(time[-1]) if len(time) else 0.0
    stop = end if options.stop is None else min(options.stop, end)
    if len(time) == 0 or not 0.0 <= options.start < stop:
        raise UsageError(
            f"no motion from {options.start:g} s to {stop:g} s: the run ended at {end:g} s"
        )
    length = stop - options.start
    speed = options.speed
    if speed is None:
        speed = next((s for s in SPEEDS if length / s <= LENGTH), SPEEDS[-1])
    count = max(1, round(length / speed * options.fps))
    times: Array = options.start + np.arange(count, dtype=np.float64) * (speed / options.fps)
    return times, speed
