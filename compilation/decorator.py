"""The decorator of compiled functions and their cache."""

import pickle
from collections.abc import Callable
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar, cast

from numba.core import config
from numba.core.caching import (
    CompileResultCacheImpl,
    FunctionCache,
    InTreeCacheLocator,
    NullCache,
    UserProvidedCacheLocator,
    UserWideCacheLocator,
)
from numba.core.compiler import CompileResult

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
        dispatcher._cache = LazyCache(function)
    return cast("Dispatcher[P, R]", dispatcher)


class LazyCache(NullCache):
    """Cache of a function that is opened at its first call, when all its imports are complete.

    Args:
        function: function that Numba compiles.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function

    @cached_property
    def _cache(self) -> NullCache:
        try:
            return CodeCache(self._function)
        except RuntimeError:  # no folder can be written
            return NullCache()

    @property
    def cache_path(self) -> str | None:
        """Folder of the files; None if no folder can be written."""
        return self._cache.cache_path

    def load_overload(self, sig: Any, target_context: Any) -> CompileResult | None:
        """Return the code for the argument types; None if it must be compiled."""
        return self._cache.load_overload(sig, target_context)

    def save_overload(self, sig: Any, data: CompileResult) -> None:
        """Keep the code for the argument types."""
        self._cache.save_overload(sig, data)


class ReadOnlyFolder(InTreeCacheLocator):
    """Folder next to the source that has code of a function and cannot be written."""

    def ensure_cache_path(self) -> None:
        """Require files of the module.

        Raises:
            OSError: there are none.
        """
        if not any(Path(self.get_cache_path()).glob(f"{Path(self._py_file).stem}.*.nbi")):
            raise FileNotFoundError(self.get_cache_path())


class Folders(CompileResultCacheImpl):
    """Choice of the folder: the first that serves."""

    _locator_classes = (
        UserProvidedCacheLocator,
        InTreeCacheLocator,
        ReadOnlyFolder,
        UserWideCacheLocator,
    )


class CodeCache(FunctionCache):
    """Numba's cache, with a stamp of all sources and with the check of indices in the key.

    Its folder is `NUMBA_CACHE_DIR`, else `__pycache__` next to the source, else one of the user.

    Args:
        function: function that Numba compiles.

    Raises:
        RuntimeError: no folder can be written.
    """

    _impl_class = Folders

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        self._cache_file._source_stamp = stamp(function.__module__)

    def load_overload(self, sig: Any, target_context: Any) -> CompileResult | None:
        """Return the code for the argument types; None if it must be compiled."""
        try:
            return super().load_overload(sig, target_context)
        except (EOFError, pickle.UnpicklingError):  # cut files, from a full disk or a power failure
            self.flush()
            return None

    def save_overload(self, sig: Any, data: CompileResult) -> None:
        """Keep the code for the argument types, if the folder can be written."""
        with suppress(OSError):
            super().save_overload(sig, data)

    def _index_key(self, sig: Any, codegen: Any) -> tuple[Any, ...]:
        return (*super()._index_key(sig, codegen), config.BOUNDSCHECK)
