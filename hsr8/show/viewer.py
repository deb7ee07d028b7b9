"""The viewer of the installed Rerun library, reachable from this machine only."""

import os
import re
import signal
import socket
import subprocess
import tempfile
import time as clock
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Literal, Self
from urllib.parse import quote

from hsr8.errors import UsageError
from hsr8.files.atomic import require_temporary
from hsr8.process.gl import VULKAN_LINE
from hsr8.process.signals import with_parent_watch

LOOPBACK = "127.0.0.1"
TIMELINE = "sim_time"
START_TIMEOUT = 60.0  # wall time until the viewer must answer [s]
STOP_TIMEOUT = 2.0  # wall time until a viewer must end after a signal [s]
SETTLING_TIME = 6.0  # wall time in which notices fade and views load [s]


def executable() -> str:
    """Return the path of the viewer's binary; the script of that name starts another process.

    Raises:
        UsageError: it is not installed.
    """
    package = find_spec("rerun_cli")
    if package is not None and package.origin is not None:
        program = Path(package.origin).with_name("rerun")
        if program.exists():
            return str(program)
    raise UsageError("the Rerun viewer is missing; `pip install rerun-sdk` installs it")


def has_display() -> bool:
    """Return whether a window can be opened."""
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def command(port: int, *words: str) -> list[str]:
    """Return the command line of a viewer that listens on `port` of this machine."""
    return [executable(), *words, "--bind", LOOPBACK, "--port", str(port)]


def show(log: Path) -> int:
    """Open a log in a window, wait until it is closed, and return the exit status."""
    words = with_parent_watch(command(free_port(), str(log)))
    return subprocess.run(words, check=False).returncode


def screenshot(log: Path, time: float, size: tuple[int, int]) -> bytes:
    """Return an image (PNG) of the viewer.

    Args:
        log: file to show.
        time: simulated time to show [s].
        size: width and height of the window [pixel].

    Raises:
        UsageError: the viewer did not start, for example because Vulkan is missing, or the log
            is damaged.
    """
    port = free_port()
    words = command(port, str(log), "--headless", "--window-size", f"{size[0]}x{size[1]}")
    with Viewer(words) as viewer:
        try:
            viewer.wait_for_port(port)
            # Imported late: runs without a viewer do not need it.
            from rerun.experimental import ViewerClient  # noqa: PLC0415

            client = ViewerClient.connect(f"rerun+http://{LOOPBACK}:{port}/proxy")
            if not viewer.poll(lambda: bool(client.get_state().recordings)):
                raise UsageError(f"{log}: no recording in this file")
            viewer.poll(lambda: _seek(client, time))
            clock.sleep(SETTLING_TIME)
            images: list[bytes] = []
            if not viewer.poll(lambda: _take(client, images)):
                raise UsageError(f"{log}: the viewer does not draw it; is the machine busy?")
            return images[0]
        except ConnectionError:  # the viewer ended
            raise viewer.failure() from None


def _take(client: object, images: list[bytes]) -> bool:
    """Append a screenshot; return False where the viewer needs more than its 15 s to draw it."""
    with suppress(TimeoutError):
        images.append(bytes(client.take_screenshot()))  # type: ignore[attr-defined]
    return bool(images)


def _seek(client: object, time: float) -> bool:
    """Go to a simulated time; a recording that is still loading has no timeline yet."""
    with suppress(ConnectionError):
        client.set_time(TIMELINE, duration=time, play_state="paused")  # type: ignore[attr-defined]
        return True
    return False


def free_port() -> int:
    """Return a port of this machine that is not in use."""
    with socket.socket() as probe:
        probe.bind((LOOPBACK, 0))
        return int(probe.getsockname()[1])


class Viewer:
    """Process of the viewer, ended by leaving its ``with`` block.

    Args:
        words: its command line.
    """

    def __init__(self, words: Sequence[str]) -> None:
        require_temporary()
        # A file, because a pipe that is not read would block the viewer.
        self._stderr = tempfile.TemporaryFile()  # noqa: SIM115  closed by `__exit__`
        try:
            self._process = subprocess.Popen(
                with_parent_watch(words),
                stdout=subprocess.DEVNULL,
                stderr=self._stderr,
                start_new_session=True,
            )
        except BaseException:
            self._stderr.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for number in (signal.SIGTERM, signal.SIGKILL):
            if not self.ended:
                os.killpg(self._process.pid, number)
                self.wait(STOP_TIMEOUT)
        self._stderr.close()

    @property
    def ended(self) -> bool:
        """Whether the process has ended."""
        return self._process.poll() is not None

    def wait(self, timeout: float | None = None) -> None:
        """Wait for the end of the process, at most `timeout` [s]."""
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(timeout)

    def poll(self, ready: Callable[[], bool]) -> bool:
        """Call `ready` until it returns True; return False after `START_TIMEOUT`.

        Raises:
            UsageError: the viewer ended.
        """
        end = clock.monotonic() + START_TIMEOUT
        while clock.monotonic() < end:
            if self.ended:
                raise self.failure()
            if ready():
                return True
            clock.sleep(0.2)
        return False

    def wait_for_port(self, port: int) -> None:
        """Wait until the viewer listens.

        Raises:
            UsageError: it ended or does not answer.
        """

        def listens() -> bool:
            with (
                suppress(OSError),
                socket.create_connection((LOOPBACK, port), timeout=1.0),
            ):
                return True
            return False

        if not self.poll(listens):
            raise self.failure()

    def failure(self) -> UsageError:
        """Return the error of a viewer that did not start, with its own message."""
        self.wait(STOP_TIMEOUT)
        self._stderr.seek(0)
        message = _message(self._stderr.read().decode(errors="replace")) if self.ended else ""
        if "Failed to load file" in message:
            return UsageError(f"the log is damaged: {message}")
        return UsageError(
            f"the Rerun viewer did not start{f': {message}' if message else ''}"
            "\n  without a graphics card it needs a software Vulkan driver; as root:  "
            f"{VULKAN_LINE}"
        )


def _message(stderr: str) -> str:
    """Return the line of an output that reports an error, without colours."""
    lines = re.sub(r"\x1b\[[0-9;]*m", "", stderr).splitlines()
    return next((line.strip() for line in lines if re.search(r"panicked|\berror", line, re.I)), "")


Kind = Literal["native", "web"]


@dataclass(frozen=True, slots=True)
class LiveView:
    """A running viewer.

    Attributes:
        address: destination of the log.
        page: address to open in a browser; empty for a native window.
        process: the viewer.
    """

    address: str
    page: str
    process: Viewer

    def wait(self) -> None:
        """Wait until the window is closed, or for Ctrl-C."""
        with suppress(KeyboardInterrupt):
            self.process.wait()


@contextmanager
def live_view(kind: Kind, log: Path | None = None) -> Iterator[LiveView]:
    """Start a viewer and end it with the context.

    Args:
        kind: native or web.
        log: finished log to show; None for a run that goes on.

    Raises:
        UsageError: it cannot be started, for example without a display.
    """
    require_display(kind)
    port, web_port = free_port(), free_port()
    words = command(port, "--expect-data-soon" if log is None else str(log))
    if kind == "web":
        words += ["--serve-web", "--web-viewer-port", str(web_port)]
    with Viewer(words) as process:
        process.wait_for_port(port)
        address = f"rerun+http://{LOOPBACK}:{port}/proxy"
        page = f"http://{LOOPBACK}:{web_port}?url={quote(address, safe='')}"
        yield LiveView(address, page if kind == "web" else "", process)


def require_display(kind: Kind) -> None:
    """Require a display for a native window.

    Raises:
        UsageError: there is none.
    """
    if kind == "native" and not has_display():
        raise UsageError(
            "--view native: no display"
            "\n  in a browser, also through `ssh -L`:  --view web"
            "\n  after the run:                        hsr8 replay RUN --screenshot log.png"
        )
