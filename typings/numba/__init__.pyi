from collections.abc import Callable
from typing import Generic, ParamSpec, TypeVar, overload

P = ParamSpec("P")
R = TypeVar("R", covariant=True)

class Dispatcher(Generic[P, R]):
    py_func: Callable[P, R]
    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R: ...

@overload
def njit(function: Callable[P, R], /) -> Dispatcher[P, R]: ...
@overload
def njit(
    *, cache: bool = ..., error_model: str = ...
) -> Callable[[Callable[P, R]], Dispatcher[P, R]]: ...
