"""``hsr8 render``: the video of a run."""

import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from hsr8.cli.options import Render
from hsr8.cli.output_file import parse_size, require_file_name, writing
from hsr8.errors import UsageError
from hsr8.files import atomic
from hsr8.process.gl import is_software, require_gl
from hsr8.recording import run_folder
from hsr8.recording.run import open_run
from hsr8.show.video.run_video import RenderedVideo, VideoOptions, render_run
from hsr8.show.video.video import FORMATS

SUFFIXES = (*FORMATS, ".png")


def main(options: Render) -> int:
    """Render the video and print its path."""
    if not 1 <= options.fps <= 120:
        raise UsageError(f"--fps: out of range, got {options.fps}; expected 1 to 120")
    if options.speed is not None and not 0.01 <= options.speed <= 1000.0:
        raise UsageError(f"--speed: out of range, got {options.speed:g}; expected 0.01 to 1000")
    run = open_run(options.run)
    renderer = require_gl()
    out = options.out or run.folder / run_folder.VIDEO
    require_file_name("--out", out, SUFFIXES)
    video = VideoOptions(
        camera=options.camera,
        size=parse_size(options.size),
        fps=options.fps,
        start=options.start,
        stop=options.stop,
        speed=options.speed,
        fine=options.fine,
    )
    console = Console(stderr=True, quiet=options.quiet)
    if is_software(renderer):
        console.print(f"drawing on the processor ({renderer})", style="dim", highlight=False)
    started = clock.perf_counter()
    with drawing(console) as show, writing("--out", out):
        made = render_run(run, video, out, show)
    _report(made, clock.perf_counter() - started, options)
    return 0


@contextmanager
def drawing(console: Console) -> Iterator[Callable[[int, int], None]]:
    """Yield a function that shows the numbers of finished frames and of all in a bar."""
    columns = (TextColumn("drawing"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("drawing", total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def _report(made: RenderedVideo, wall: float, options: Render) -> None:
    if options.json:
        result = {
            "video": str(made.video),
            "thumbnail": None if made.thumbnail is None else str(made.thumbnail),
            "frames": made.frames,
            "duration_s": made.duration,
            "speed": made.speed,
            "wall_time_s": wall,
        }
        print(atomic.dumps(result))
    elif not options.quiet:
        print(f"{'video' if made.thumbnail else 'image':<12}{made.video}")
        if made.thumbnail:
            print(f"thumbnail   {made.thumbnail}")
        print(
            f"{made.frames} frames, {made.duration:.1f} s at {made.speed:g}x, drawn in {wall:.0f} s"
        )
