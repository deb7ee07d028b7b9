from collections.abc import Callable
from typing import Generic, ParamSpec, TypeVar

from numba.core.caching import NullCache

__version__: str

P = ParamSpec("P")
R_co = TypeVar("R_co", covariant=True)

class _CompileStats:
    cache_path: str | None

class Dispatcher(Generic[P, R_co]):
    py_func: Callable[P, R_co]
    _cache: NullCache
    @property
    def stats(self) -> _CompileStats: ...
    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R_co: ...
