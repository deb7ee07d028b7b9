"""Video of a run that is still in progress, drawn from the records that it has written so far."""

import time as clock
from collections.abc import Callable, Iterator
from functools import partial
from math import inf
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hsr8.recorder.run.run_reader import StoredRun, open_run
from hsr8.render.run_images import RunImages
from hsr8.render.run_video import (
    Progress,
    RenderedVideo,
    VideoOptions,
    draw_video,
    instants,
    render_run,
)
from hsr8.world.field.generator import draw_layout

Array = NDArray[np.float64]

PERIOD = 0.5  # wall time between two looks at the run folder [s]
PARTS = 16  # of a video: records are read when those of one more part are written


class _EndedEarly(Exception):
    """The video of the run has other frames than that of a run of full duration."""


def follow_run(
    run: StoredRun,
    options: VideoOptions,
    out: Path,
    progress: Progress,
    stopped: Callable[[], bool],
) -> RenderedVideo:
    """Draw the video of a run during the run; errors as `render_run`.

    The frames are those that `render_run` draws after the run. Their number and speed follow from
    the length of the run. The video is begun for the full duration if the mission has no goal; if
    the run ends early, it is drawn again.

    Args:
        run: run in progress.
        options: options of the video.
        out: file to write, no image.
        progress: called with the number of finished frames and of all.
        stopped: returns whether the run counts as ended although its manifest does not say so.
    """
    watched = _GrowingRun(run.path, stopped)
    scenario = run.scenario()
    layout = draw_layout(scenario, run.seed)
    if layout.endless or not len(layout.waypoints):
        times, speed = instants(np.array([0.0, scenario.duration]), options)
        order = partial(watched.order, times=times, options=options)
        try:
            begun = watched.started()
            return draw_video(begun, options, out, progress, times=times, speed=speed, order=order)
        except _EndedEarly:
            pass
    return render_run(watched.ended(), options, out, progress)


class _GrowingRun:
    """Run folder that another process writes.

    Args:
        path: path of the folder.
        stopped: returns whether the other process is gone.
    """

    def __init__(self, path: Path, stopped: Callable[[], bool]) -> None:
        self._path = path
        self._stopped = stopped

    def started(self) -> StoredRun:
        """Return the run as soon as its first batch of records is complete.

        Raises:
            _EndedEarly: it ended without any.
        """
        run, _ = self._recorded(0.0)
        if not len(run.seconds):
            raise _EndedEarly
        return run

    def ended(self) -> StoredRun:
        """Return the run after its end."""
        return self._recorded(inf)[0]

    def order(self, images: RunImages, times: Array, options: VideoOptions) -> Iterator[int]:
        """Yield the numbers of the images as soon as they can be drawn.

        Raises:
            _EndedEarly: the run ended before its full duration.
        """
        drawn, over, part = 0, False, (times[-1] - times[0]) / PARTS
        while True:
            ready = len(times) if over else images.ready
            yield from range(drawn, ready)
            drawn = max(drawn, ready)
            if drawn == len(times):
                return
            run, over = self._recorded(images.recorded + part)
            if over and len(instants(run.records["time"], options)[0]) != len(times):
                raise _EndedEarly
            images.update(run)

    def _recorded(self, time: float) -> tuple[StoredRun, bool]:
        """Return the run, and whether it has ended, after waiting for records up to a time [s]."""
        while True:
            stopped = self._stopped()  # before the records are read
            run = open_run(self._path)
            over = stopped or not run.running
            seconds = run.seconds["time"]  # a small table
            if over or (len(seconds) and seconds[-1] >= time):
                return run, over
            clock.sleep(PERIOD)
