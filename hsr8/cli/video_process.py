"""Second process of ``hsr8 run --video``: it draws the video during the run."""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hsr8.recorder.run import run_folder


@contextmanager
def video_process(path: Path, *, quiet: bool) -> Iterator[None]:
    """Draw the video of the run that is recorded in a context; wait for it at the end.

    After an error or an interrupted run, the video shows what was recorded. An interrupt during
    the wait ends the process without a video.

    Args:
        path: run folder, which has a manifest.
        quiet: print nothing.
    """
    command = [sys.executable, "-P", "-m", "hsr8", "render", str(path), "--follow", "--quiet"]
    process = subprocess.Popen(command, start_new_session=True)  # Ctrl-C is for the run only
    try:
        yield
    except KeyboardInterrupt:
        process.terminate()
        raise
    finally:
        try:
            if not quiet and process.poll() is None:
                print("drawing the rest of the video", file=sys.stderr, flush=True)
            if process.wait() == 0 and not quiet:
                print(f"video       {path / run_folder.VIDEO}")
        except KeyboardInterrupt:
            process.terminate()
            process.wait()
            raise
