"""How a command loads the modules that it needs."""

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def loading() -> Iterator[None]:
    """Switches the garbage collector off during imports and freezes what they made.

    That saves an eighth of the start. It freezes nothing if nothing was imported.
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
