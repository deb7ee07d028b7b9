from collections.abc import Callable
from typing import Any

from numba import Dispatcher

class CPUDispatcher(Dispatcher[..., Any]):
    targetdescr: Any
    targetctx: Any
    typingctx: Any
    targetoptions: dict[str, Any]
    _compiler: Any
    def __init__(
        self, py_func: Callable[..., Any], /, *args: Any, targetoptions: dict[str, Any]
    ) -> None: ...
