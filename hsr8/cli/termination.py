"""Handlers of SIGINT (Ctrl-C) and SIGTERM, which schedulers and `timeout` send."""

import signal
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType
from typing import Any


@contextmanager
def on_signals(
    numbers: tuple[int, ...], handler: Callable[[int, FrameType | None], Any]
) -> Iterator[None]:
    """Handle signals in a context; the handlers before it are restored."""
    before = {number: signal.signal(number, handler) for number in numbers}
    try:
        yield
    finally:
        for number, previous in before.items():
            signal.signal(number, previous)


def like_ctrl_c() -> AbstractContextManager[None]:
    """Return a context in which SIGTERM raises KeyboardInterrupt."""
    return on_signals((signal.SIGTERM,), signal.default_int_handler)
