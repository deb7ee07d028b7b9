"""How a command loads the modules that it needs."""

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def loading() -> Iterator[None]:
    """What is loaded stays: the garbage collector looks through it neither now nor later.

    It would go through all of it again and again while it grows, an eighth of a start. Where all
    was loaded before, nothing is kept: it would be what an earlier command left behind.
    """
    loaded, collects = len(sys.modules), gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if len(sys.modules) > loaded:
            gc.freeze()
        if collects:
            gc.enable()
