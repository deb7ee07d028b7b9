"""A viewer that shows a run while it goes on; nobody but this machine can reach it."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Literal
from urllib.parse import quote

from hsr8.errors import UsageError
from hsr8.render import viewer

LOOPBACK = "127.0.0.1"
Kind = Literal["native", "web"]


@dataclass(frozen=True, slots=True)
class LiveView:
    """A viewer that has been started.

    Attributes:
        address: to which the log is sent.
        page: to open in a browser; empty if it has a window of its own.
        process: the viewer.
    """

    address: str
    page: str
    process: viewer.Viewer

    def wait(self) -> None:
        """Wait until the window is closed, or for Ctrl-C."""
        with suppress(KeyboardInterrupt):
            self.process.wait()


@contextmanager
def live_view(kind: Kind) -> Iterator[LiveView]:
    """A viewer for the time of the context.

    Raises:
        UsageError: it cannot be started, for example for want of a display.
    """
    require_display(kind)
    port, web_port = viewer.free_port(), viewer.free_port()
    with viewer.running(command(kind, port, web_port)) as process:
        viewer.connected(process, port)
        address = f"rerun+http://{LOOPBACK}:{port}/proxy"
        page = f"http://{LOOPBACK}:{web_port}?url={quote(address, safe='')}"
        yield LiveView(address, page if kind == "web" else "", process)


def require_display(kind: Kind) -> None:
    """Make sure that a viewer can be shown.

    Raises:
        UsageError: it is to have a window, and there is no display.
    """
    if kind == "native" and not viewer.has_display():
        raise UsageError(
            "--view native: there is no display to open the viewer on"
            "\n  in a browser, also through `ssh -L`:  --view web"
            "\n  afterwards:                           hsr8 replay RUN --screenshot log.png"
        )


def command(kind: Kind, port: int, web_port: int) -> list[str]:
    """Command line of a viewer that listens for a log on `port`, and for browsers on another."""
    words = [viewer.executable(), "--bind", LOOPBACK, "--port", str(port), "--expect-data-soon"]
    return (
        words if kind == "native" else [*words, "--serve-web", "--web-viewer-port", str(web_port)]
    )
