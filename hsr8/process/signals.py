"""Handlers of SIGINT (Ctrl-C) and SIGTERM, which schedulers and `timeout` send."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType
from typing import Any


@contextmanager
def on_signals(
    numbers: tuple[int, ...], handler: Callable[[int, FrameType | None], Any]
) -> Iterator[None]:
    """Handle signals in a context; the handlers before it are restored.

    An ignored signal stays ignored; outside of the main thread there are no handlers.
    """
    before = {}
    if threading.current_thread() is threading.main_thread():
        handled = [n for n in numbers if signal.getsignal(n) is not signal.SIG_IGN]
        before = {number: signal.signal(number, handler) for number in handled}
    try:
        yield
    finally:
        for number, previous in before.items():
            signal.signal(number, previous)


def like_ctrl_c() -> AbstractContextManager[None]:
    """Return a context in which SIGTERM raises KeyboardInterrupt."""
    return on_signals((signal.SIGTERM,), signal.default_int_handler)


def stop_on_signals(stop: Callable[[], object]) -> AbstractContextManager[None]:
    """Return a context in which the first signal calls `stop`; a second one ends at once."""

    def handle(number: int, frame: FrameType | None) -> None:
        signal.signal(number, signal.default_int_handler)
        stop()

    return on_signals((signal.SIGINT, signal.SIGTERM), handle)
