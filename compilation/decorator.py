"""The decorator of compiled functions and their cache."""

import hashlib
import pickle
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar, cast

from numba.core import config
from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps
from numba.core.sigutils import normalize_signature

from compilation import store
from compilation.function import OPTIONS, CompiledFunction
from compilation.sources import stamp

if TYPE_CHECKING:
    from numba import Dispatcher

P = ParamSpec("P")
R = TypeVar("R")


def compiled(function: Callable[P, R]) -> "Dispatcher[P, R]":
    """Compile a function of numbers, arrays and records at its first call, or load it from disk.

    Args:
        function: function at the top level of a module; the code of one typed in is not kept.

    Raises:
        TypeError: the function uses variables of an enclosing function, which the file on disk
            would not distinguish.
    """
    if function.__closure__:
        raise TypeError(f"{function.__qualname__}: closure; expected a function of a module")
    if config.DISABLE_JIT:
        return cast("Dispatcher[P, R]", function)
    dispatcher = CompiledFunction(function, targetoptions=OPTIONS)
    if Path(function.__code__.co_filename).is_file():
        dispatcher._cache = CodeCache(function)
    return cast("Dispatcher[P, R]", dispatcher)


class CodeCache(NullCache):
    """Machine code of one function on disk, a file for each combination of argument types.

    A file that is stale or damaged counts as missing: the function is compiled and its file
    replaced.

    Args:
        function: function that Numba compiles.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._file = Path(function.__code__.co_filename)
        self._name = f"{self._file.stem}.{function.__qualname__}"
        self._stamp = stamp(self._file)

    @property
    def cache_path(self) -> str:
        """Preferred folder of the files."""
        return str(next(store.folders(self._file)))

    def load_overload(self, sig: Any, target_context: Any) -> CompileResult | None:
        """Return the code for the argument types; None if it must be compiled."""
        target_context.refresh()
        name = self._file_name(sig, target_context.codegen())
        payload = store.load(self._file, name, self._stamp)
        if payload is None:
            return None
        return CompileResult._rebuild(target_context, *pickle.loads(payload))

    def save_overload(self, sig: Any, data: CompileResult) -> None:
        """Keep the code for the argument types, where a folder can be written."""
        if data.library.has_dynamic_globals:  # addresses of this process
            return
        name = self._file_name(sig, data.library.codegen)
        store.save(self._file, name, self._stamp, dumps(data._reduce()))

    def _file_name(self, sig: Any, codegen: Any) -> str:
        """Return the name of the file for argument types, processor and options of Numba."""
        types, _ = normalize_signature(sig)
        key = repr((types, codegen.magic_tuple(), config.BOUNDSCHECK, config.OPT))
        digest = hashlib.sha256(key.encode()).hexdigest()[:16]
        return f"{self._name}-{sys.implementation.cache_tag}-{digest}{store.SUFFIX}"
