"""Second process of ``hsr8 run --video``: it draws the video during the run."""

import signal
import subprocess
import sys
from pathlib import Path
from typing import Self

from hsr8.parent_watch import with_parent_watch
from hsr8.recorder.run import run_folder


class VideoProcess:
    """Process that draws the video of a run during and after the run, used by ``with``.

    Args:
        path: run folder, which has a manifest.
        quiet: print nothing.
    """

    def __init__(self, path: Path, *, quiet: bool) -> None:
        self._file, self._quiet = path / run_folder.VIDEO, quiet
        command = [sys.executable, "-P", "-m", "hsr8", "render", str(path), "--follow", "--quiet"]
        # Ctrl-C is for the run only. The end of this process is a SIGTERM to the other one.
        self._process = subprocess.Popen(with_parent_watch(command), start_new_session=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        """After an error, wait for the video of the recorded part; after an interrupt, end it."""
        if kind is not None:
            if issubclass(kind, KeyboardInterrupt):
                self._process.send_signal(signal.SIGINT)
            self.wait()

    def wait(self) -> int:
        """Wait for the video; return the exit code of the process.

        An interrupt during the wait ends the process without a video.
        """
        if not self._quiet and self._process.poll() is None:
            print("drawing the rest of the video", file=sys.stderr, flush=True)
        try:
            code = self._process.wait()
        except KeyboardInterrupt:
            self._process.send_signal(signal.SIGINT)
            self._process.wait()
            raise
        if code == 0 and not self._quiet:
            print(f"video       {self._file}")
        return code
