"""The Rerun viewer that belongs to the installed library, bound to this machine only."""

import os
import re
import signal
import socket
import subprocess
import tempfile
import time as clock
from collections.abc import Sequence
from contextlib import AbstractContextManager, closing, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from hsr8.errors import UsageError
from hsr8.gl import VULKAN_LINE
from hsr8.parent_watch import with_parent_watch

if TYPE_CHECKING:
    from rerun.experimental import ViewerClient

TIMELINE = "sim_time"
START_LIMIT = 30.0  # the viewer must answer within this wall time [s]
ENDING = 2.0  # a viewer that went down is gone within this wall time [s]
SETTLE = 6.0  # notices fade and views load in this wall time [s]


def executable() -> str:
    """Path of the viewer: the program itself, for the script of that name starts another process.

    Raises:
        UsageError: it is not installed.
    """
    package = find_spec("rerun_cli")
    if package is not None and package.origin is not None:
        program = Path(package.origin).with_name("rerun")
        if program.exists():
            return str(program)
    raise UsageError("the Rerun viewer is missing; `pip install rerun-sdk` brings it")


def has_display() -> bool:
    """Whether a window can be opened."""
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def show(logs: Sequence[Path]) -> int:
    """Open the `logs` of a run in a window and wait until it is closed; its exit status."""
    command = with_parent_watch(_command(logs, free_port()))
    return subprocess.run(command, check=False).returncode


def screenshot(logs: Sequence[Path], time: float, size: tuple[int, int]) -> bytes:
    """Picture (PNG) of the viewer with the `logs` of a run at simulated `time` [s].

    Args:
        logs: files of a run.
        time: [s].
        size: width and height of the window [pixel].

    Raises:
        UsageError: the viewer did not start, for example for want of Vulkan, or `logs` hold
            no recording.
    """
    port = free_port()
    window = ("--headless", "--window-size", f"{size[0]}x{size[1]}")
    with running([*_command(logs, port), *window]) as viewer:
        try:
            client = _connect(viewer, port)
            _wait_for_recording(client, viewer, logs[0])
            _stop_at(client, viewer, time)
            clock.sleep(SETTLE)
            return bytes(client.take_screenshot())
        except ConnectionError:  # it went down while it was talked to
            raise _failed(viewer) from None


def _command(logs: Sequence[Path], port: int) -> list[str]:
    return [executable(), *map(str, logs), "--bind", "127.0.0.1", "--port", str(port)]


def free_port() -> int:
    """A port of this machine that nobody listens on."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class Viewer:
    """A process of the viewer.

    Args:
        command: its command line.
    """

    def __init__(self, command: Sequence[str]) -> None:
        # Not a pipe: nobody has to read while it writes.
        self._said = tempfile.TemporaryFile()  # noqa: SIM115  closed by `close`
        try:
            self._process = subprocess.Popen(
                with_parent_watch(command),
                stdout=subprocess.DEVNULL,
                stderr=self._said,
                start_new_session=True,
            )
        except BaseException:
            self._said.close()
            raise

    @property
    def ended(self) -> bool:
        """Whether it has ended."""
        return self._process.poll() is not None

    def wait(self, limit: float | None = None) -> None:
        """Wait for its end, at most `limit` [s]."""
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(limit)

    def complaint(self) -> str:
        """What went wrong, as it said before it ended; empty if it said nothing of the kind."""
        self._said.seek(0)
        return complaint(self._said.read().decode(errors="replace"))

    def close(self) -> None:
        """End it."""
        for number in (signal.SIGTERM, signal.SIGKILL):
            if not self.ended:
                os.killpg(self._process.pid, number)
                self.wait(ENDING)
        self._said.close()


def running(command: Sequence[str]) -> AbstractContextManager[Viewer]:
    """A viewer for the time of the context."""
    return closing(Viewer(command))


def _connect(viewer: Viewer, port: int) -> "ViewerClient":
    from rerun.experimental import ViewerClient  # noqa: PLC0415  a run without a viewer has no need

    connected(viewer, port)
    return ViewerClient.connect(f"rerun+http://127.0.0.1:{port}/proxy")


def connected(viewer: Viewer, port: int) -> None:
    """Wait until the viewer listens.

    Raises:
        UsageError: it ended, or does not answer.
    """
    end = clock.monotonic() + START_LIMIT
    while clock.monotonic() < end and not viewer.ended:
        try:
            with socket.create_connection(("127.0.0.1", port), timeout=1.0):
                return
        except OSError:
            clock.sleep(0.2)
    raise _failed(viewer)


def _wait_for_recording(client: "ViewerClient", viewer: Viewer, log: Path) -> None:
    end = clock.monotonic() + START_LIMIT
    while clock.monotonic() < end and not viewer.ended:
        if client.get_state().recordings:
            return
        clock.sleep(0.2)
    if not viewer.ended:
        raise UsageError(f"the Rerun viewer finds no recording in {log}")
    raise _failed(viewer)


def _stop_at(client: "ViewerClient", viewer: Viewer, time: float) -> None:
    """Go to a time; a recording that is still being read has none for a while."""
    end = clock.monotonic() + START_LIMIT
    while True:
        try:
            client.set_time(TIMELINE, duration=time, play_state="paused")
            return
        except ConnectionError:
            if clock.monotonic() >= end or viewer.ended:
                raise
            clock.sleep(0.2)


def _failed(viewer: Viewer) -> UsageError:
    viewer.wait(ENDING)
    said = viewer.complaint() if viewer.ended else ""
    if "Failed to load file" in said:
        return UsageError(f"the log is damaged, the Rerun viewer cannot read it: {said}")
    return UsageError(
        f"the Rerun viewer did not start{f': {said}' if said else ''}"
        f"\n  without a graphics card it needs Vulkan in software; as root:  {VULKAN_LINE}"
    )


def complaint(said: str) -> str:
    """The line of the viewer's messages that says what went wrong, without colours."""
    lines = re.sub(r"\x1b\[[0-9;]*m", "", said).splitlines()
    return next((line.strip() for line in lines if re.search(r"panicked|\berror", line, re.I)), "")
