"""A recorded run as a video."""

import hashlib
import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.run_reader import Run
from hsr8.render.animation import KINDS, AnimationWriter, require_room
from hsr8.render.png import write_png
from hsr8.render.run_images import RunImages
from hsr8.render.scene_renderer import Image
from hsr8.render.segments import Segments, join
from hsr8.render.video import VideoWriter
from hsr8.version import VERSION
from hsr8.world.field.generator import draw_layout

Array = NDArray[np.float64]
Tell = Callable[[int, int], None]

SPEEDS = (1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 60.0)
LENGTH = 60.0  # a video is not longer than this unless its speed is asked for [s]
SEGMENT = 150  # frames that an interrupted video loses at most


@dataclass(frozen=True, slots=True)
class VideoOptions:
    """What to draw.

    Attributes:
        camera: ``dashboard``, ``follow``, ``head`` or a camera of the model.
        size: width and height, both even [pixel].
        fps: frames per second [1/s].
        start, stop: simulated time [s]; None is the end of the run.
        speed: simulated seconds per second of video; None chooses.
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
    """What was drawn.

    Attributes:
        video: file.
        thumbnail: file of a picture that stands for it; None where it is a picture itself.
        frames: number of images.
        reused: of these, drawn before by a call that was interrupted.
        duration: of the video [s].
        speed: simulated seconds per second of video.
    """

    video: Path
    thumbnail: Path | None
    frames: int
    reused: int
    duration: float
    speed: float


def render_run(run: Run, options: VideoOptions, out: Path, tell: Tell) -> RenderedVideo:
    """Draw a run as a video, an animation or a picture; the ending of the name says as what.

    Args:
        run: recorded run.
        options: what to draw; a picture is of its `start`.
        out: file to write: ``.mp4``, ``.gif``, ``.webp`` or ``.png``. The thumbnail of a video
            is beside it, a PNG.
        tell: called with the number of frames done and of all.

    Raises:
        OSError: a file cannot be written.
        UsageError: the run has no motion in the time asked for, there is no such camera, a GIF
            would be too large, or somebody else is drawing the same video.
        RenderingUnavailable: no OpenGL draws here.
    """
    times, speed = instants(run.trajectory().time, options)
    kind = out.suffix.lower()
    if kind == ".png":
        times, speed = times[:1], 1.0
    require_room(out, options.size, len(times))
    scenario = run.scenario()
    layout = draw_layout(scenario, run.seed)
    with RunImages(
        run,
        scenario,
        layout,
        times=times,
        size=options.size,
        fps=options.fps,
        speed=speed,
        fine=options.fine,
    ) as images:
        draw = images.camera(options.camera)
        thumbnail, reused = None, 0
        if kind == ".png":
            write_png(out, draw(0))
            tell(1, 1)
        elif kind in KINDS:
            with AnimationWriter(out, options.size, options.fps) as animation:
                for index in range(len(times)):
                    animation.add(draw(index))
                    tell(index + 1, len(times))
        else:
            with Segments(out, _key(run, options, speed)) as segments:
                reused = _shoot(segments, draw, len(times), options, tell)
                parts = [segments.path(k) for k in range(len(_lengths(len(times))))]
                join(parts, _lengths(len(times)), options.fps, out)
                thumbnail = out.with_suffix(".png")
                segments.thumbnail.replace(thumbnail)
                segments.remove()
    return RenderedVideo(out, thumbnail, len(times), reused, len(times) / options.fps, speed)


def _shoot(
    segments: Segments, draw: Callable[[int], Image], count: int, options: VideoOptions, tell: Tell
) -> int:
    """Draw the segments that are not there yet; the number of frames that were."""
    middle, first, reused = count // 2, 0, 0
    for number, length in enumerate(_lengths(count)):
        if segments.done(number):
            reused += length
            first += length
            tell(first, count)
            continue
        with VideoWriter(segments.path(number), options.size, options.fps) as video:
            for index in range(first, first + length):
                picture = draw(index)
                video.add(picture)
                if index == middle:
                    write_png(segments.thumbnail, picture)
                tell(index + 1, count)
        first += length
    return reused


def _lengths(count: int) -> list[int]:
    """Frames of each segment of a video of `count` frames."""
    return [min(SEGMENT, count - first) for first in range(0, count, SEGMENT)]


def _key(run: Run, options: VideoOptions, speed: float) -> str:
    """Tells videos apart that are not made of the same images."""
    files = (run_folder.SCENARIO, run_folder.TRAJECTORY, run_folder.FRAMES)
    stamps = []
    for file in (run.path / name for name in files):
        if file.exists():
            stamps.append([file.name, file.stat().st_size, file.stat().st_mtime_ns])
    told = json.dumps([VERSION, SEGMENT, speed, asdict(options), str(run.path.resolve()), stamps])
    return hashlib.blake2b(told.encode(), digest_size=16).hexdigest()


def instants(time: Array, options: VideoOptions) -> tuple[Array, float]:
    """Simulated time of every frame (n,) [s], and the speed.

    Raises:
        UsageError: nothing was recorded between start and stop.
    """
    end = float(time[-1]) if len(time) else 0.0
    stop = end if options.stop is None else min(options.stop, end)
    if len(time) == 0 or not 0.0 <= options.start < stop:
        raise UsageError(
            f"nothing to draw from {options.start:g} s to {stop:g} s: the run ended at {end:g} s"
        )
    length = stop - options.start
    speed = options.speed
    if speed is None:
        speed = next((s for s in SPEEDS if length / s <= LENGTH), SPEEDS[-1])
    count = max(1, round(length / speed * options.fps))
    times: Array = options.start + np.arange(count, dtype=np.float64) * (speed / options.fps)
    return times, speed
