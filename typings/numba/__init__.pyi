from collections.abc import Callable
from typing import Generic, ParamSpec, TypeVar, overload

P = ParamSpec("P")
R_co = TypeVar("R_co", covariant=True)

class Dispatcher(Generic[P, R_co]):
    py_func: Callable[P, R_co]
    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R_co: ...

@overload
def njit(function: Callable[P, R_co], /) -> Dispatcher[P, R_co]: ...
@overload
def njit(
    *, cache: bool = ..., error_model: str = ...
) -> Callable[[Callable[P, R_co]], Dispatcher[P, R_co]]: ...
