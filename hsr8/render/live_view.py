"""Viewer that shows a run while it goes on, reachable from this machine only."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Literal
from urllib.parse import quote

from hsr8.errors import UsageError
from hsr8.render import viewer

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
    process: viewer.Viewer

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
    port, web_port = viewer.free_port(), viewer.free_port()
    words = viewer.command(port, "--expect-data-soon" if log is None else str(log))
    if kind == "web":
        words += ["--serve-web", "--web-viewer-port", str(web_port)]
    with viewer.Viewer(words) as process:
        process.wait_for_port(port)
        address = f"rerun+http://{viewer.LOOPBACK}:{port}/proxy"
        page = f"http://{viewer.LOOPBACK}:{web_port}?url={quote(address, safe='')}"
        yield LiveView(address, page if kind == "web" else "", process)


def require_display(kind: Kind) -> None:
    """Require a display for a native window.

    Raises:
        UsageError: there is none.
    """
    if kind == "native" and not viewer.has_display():
        raise UsageError(
            "--view native: no display"
            "\n  in a browser, also through `ssh -L`:  --view web"
            "\n  after the run:                        hsr8 replay RUN --screenshot log.png"
        )
