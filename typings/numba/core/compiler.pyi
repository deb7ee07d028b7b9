from collections.abc import Callable
from typing import Any, Self

class CompileResult:
    fndesc: Any
    library: Any
    signature: Any
    def _reduce(self) -> tuple[Any, ...]: ...
    @classmethod
    def _rebuild(cls, target_context: Any, *states: Any) -> Self: ...

class Flags:
    no_compile: bool
    no_cpython_wrapper: bool

def compile_extra(
    typingctx: Any,
    targetctx: Any,
    func: Callable[..., Any],
    args: tuple[Any, ...],
    return_type: Any,
    flags: Flags,
    locals: dict[str, Any],
    library: Any,
) -> CompileResult: ...
