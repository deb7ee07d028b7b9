"""Sources of the code of a compiled function.

Numba compiles the functions that a function calls, and the constants that it uses, into its code.
They come from its own module, from modules that this one imports, directly or not, or are constants
that one of these modules imports by name.
"""

import hashlib
import sys
from functools import cache
from pathlib import Path
from types import ModuleType

import numba
import numpy as np

OWN = "compilation.decorator"


@cache
def stamp(module: str) -> bytes:
    """Return a digest of the sources of the compiled functions of a module, and of Numba's version.

    Args:
        module: name of an imported module.

    Returns:
        Digest of 32 bytes, equal on all machines.
    """
    digests = sorted(_digest(name) for name in closure(module) | closure(OWN))
    return hashlib.sha256(b"".join([numba.__version__.encode(), *digests])).digest()


def closure(module: str) -> set[str]:
    """Return the names of a module and of the modules that it imports, directly or not."""
    reached, waiting = {module}, [module]
    while waiting:
        new = _imports(waiting.pop()) - reached
        reached |= new
        waiting += new
    return reached


@cache
def _imports(module: str) -> set[str]:
    """Return the modules of the functions, classes and modules that a module refers to.

    Other packages contribute compiled functions only.
    """
    here, package = sys.modules[module], module.partition(".")[0]
    names = set()
    for value in vars(here).values():
        if isinstance(value, ModuleType):
            # A package refers to all of its modules that any program has imported.
            name = "" if hasattr(here, "__path__") else value.__name__
        else:
            name = str(getattr(value, "__module__", None))
        is_compiled = hasattr(value, "py_func") and not isinstance(value, type)
        if name in sys.modules and (is_compiled or name.partition(".")[0] == package):
            names.add(name)
    return names


@cache
def _digest(module: str) -> bytes:
    """Return a digest of the file of a module and of its constants."""
    here = sys.modules[module]
    digest = hashlib.sha256(Path(str(here.__file__)).read_bytes())
    for name, value in sorted(vars(here).items()):
        if _is_constant(value) and not name.startswith("__"):
            digest.update(f"{name} {value!r}".encode())
        elif isinstance(value, np.ndarray):
            digest.update(name.encode() + value.tobytes())
    return digest.digest()


def _is_constant(value: object) -> bool:
    """Whether a value can be a constant in compiled code, and `repr` states all of it."""
    if isinstance(value, tuple):
        return all(map(_is_constant, value))
    return isinstance(value, bool | int | float | str | np.generic | np.dtype)
