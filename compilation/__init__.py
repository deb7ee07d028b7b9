"""Compilation of inner loops with Numba, kept on disk; the base of the three libraries.

    from compilation import compiled

    @compiled
    def distance(point, line): ...

Compiled functions may call each other and use constants across files: a function is compiled again
when its file or any project file that it imports changed. `NUMBA_DISABLE_JIT=1` leaves every
function as it is written, for breakpoints and prints. `compilation.value` makes classes of small
values, as cheap as Python allows.
"""

from compilation.decorator import compiled

__all__ = ["compiled"]
