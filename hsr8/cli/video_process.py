"""Second process of ``hsr8 run --video``: it draws the video during the run."""

import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hsr8.parent_watch import with_parent_watch
from hsr8.recorder.run import run_folder


@contextmanager
def video_process(path: Path, *, quiet: bool) -> Iterator[None]:
    """Draw the video of the run that is recorded in a context; wait for it at the end.

    After an error, an interrupt or a kill of this process, the video shows the recorded part. An
    interrupt during the wait ends the process without a video.

    Args:
        path: run folder, which has a manifest.
        quiet: print nothing.
    """
    command = [sys.executable, "-P", "-m", "hsr8", "render", str(path), "--follow", "--quiet"]
    # Ctrl-C is for the run only. The end of this process is a SIGTERM to the other one.
    process = subprocess.Popen(with_parent_watch(command), start_new_session=True)
    try:
        yield
    except KeyboardInterrupt:
        process.send_signal(signal.SIGINT)
        raise
    finally:
        try:
            if not quiet and process.poll() is None:
                print("drawing the rest of the video", file=sys.stderr, flush=True)
            if process.wait() == 0 and not quiet:
                print(f"video       {path / run_folder.VIDEO}")
        except KeyboardInterrupt:
            process.send_signal(signal.SIGINT)
            process.wait()
            raise
