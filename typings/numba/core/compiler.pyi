from collections.abc import Callable
from typing import Any

class CompileResult:
    fndesc: Any
    library: Any
    signature: Any

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
