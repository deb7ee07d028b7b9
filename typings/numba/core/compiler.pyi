from typing import Any, Self

class CompileResult:
    library: Any
    def _reduce(self) -> tuple[Any, ...]: ...
    @classmethod
    def _rebuild(cls, target_context: Any, *states: Any) -> Self: ...
