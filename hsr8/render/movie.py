"""A recorded run as a video."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.run_reader import Run
from hsr8.render.png import write_png
from hsr8.render.scene_pictures import Pictures
from hsr8.render.video import VideoWriter
from hsr8.scenario.loader import load
from hsr8.world.generator import draw_layout

Array = NDArray[np.float64]

SPEEDS = (1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 60.0)
LENGTH = 60.0  # a video is not longer than this unless its speed is asked for [s]
SHORT = 300  # a video of so many frames is drawn finely


@dataclass(frozen=True, slots=True)
class Shot:
    """What to draw.

    Attributes:
        camera: ``dashboard``, ``follow``, ``head`` or a camera of the model.
        size: width and height, both even [pixel].
        fps: frames per second [1/s].
        start, stop: simulated time [s]; None is the end of the run.
        speed: simulated seconds per second of video; None chooses.
    """

    camera: str = "dashboard"
    size: tuple[int, int] = (960, 540)
    fps: int = 25
    start: float = 0.0
    stop: float | None = None
    speed: float | None = None


@dataclass(frozen=True, slots=True)
class Film:
    """What was drawn.

    Attributes:
        video, thumbnail: files.
        frames: number of pictures.
        duration: of the video [s].
        speed: simulated seconds per second of video.
    """

    video: Path
    thumbnail: Path
    frames: int
    duration: float
    speed: float


def film(run: Run, shot: Shot, out: Path, tell: Callable[[int, int], None]) -> Film:
    """Draw the video of a run.

    Args:
        run: recorded run.
        shot: what to draw.
        out: file to write; the thumbnail is beside it, a PNG.
        tell: called with the number of frames done and of all.

    Raises:
        OSError: a file cannot be written.
        UsageError: the run has no motion in the time asked for, or there is no such camera.
        RenderingUnavailable: no OpenGL draws here.
    """
    times, speed = instants(run.trajectory().time, shot)
    scenario = load(str(run.scenario_file))
    layout = draw_layout(scenario, run.seed)
    thumbnail = out.with_suffix(".png")
    middle = len(times) // 2
    with Pictures(
        run,
        scenario,
        layout,
        times=times,
        size=shot.size,
        fps=shot.fps,
        speed=speed,
        fine=len(times) <= SHORT,
    ) as pictures:
        draw = pictures.camera(shot.camera)
        with VideoWriter(out, shot.size, shot.fps) as video:
            for index in range(len(times)):
                picture = draw(index)
                video.add(picture)
                if index == middle:
                    write_png(thumbnail, picture)
                tell(index + 1, len(times))
    return Film(out, thumbnail, len(times), len(times) / shot.fps, speed)


def instants(time: Array, shot: Shot) -> tuple[Array, float]:
    """Simulated time of every frame (n,) [s], and the speed.

    Raises:
        UsageError: nothing was recorded between start and stop.
    """
    end = float(time[-1]) if len(time) else 0.0
    stop = end if shot.stop is None else min(shot.stop, end)
    if len(time) == 0 or not 0.0 <= shot.start < stop:
        raise UsageError(
            f"nothing to draw from {shot.start:g} s to {stop:g} s: the run ended at {end:g} s"
        )
    length = stop - shot.start
    speed = shot.speed
    if speed is None:
        speed = next((s for s in SPEEDS if length / s <= LENGTH), SPEEDS[-1])
    count = max(1, round(length / speed * shot.fps))
    times: Array = shot.start + np.arange(count, dtype=np.float64) * (speed / shot.fps)
    return times, speed
