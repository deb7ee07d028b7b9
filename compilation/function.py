"""Compiled functions: Python calls an entry point, other compiled functions include the code."""

from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompileResult, Flags, compile_extra
from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature
from numba.core.types import unliteral
from numba.core.typing import make_concrete_template

OPTIONS = {"nopython": True, "boundscheck": None, "no_cfunc_wrapper": True}


class CompiledFunction(CPUDispatcher):
    """Function that Python and other compiled functions call.

    Numba by default optimises and translates a function for its own sake and again within each
    caller, up to the entry point from Python, and lowers it for each constant argument. Here a
    function called from compiled code is lowered once, and the entry point optimises and translates
    all of its code at once.

    The arguments are those of `numba.core.dispatcher.Dispatcher`.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._parts: dict[tuple[Any, ...], CompileResult] = {}

    def get_call_template(self, args: Any, kws: Any) -> tuple[Any, ...]:
        """Return what Numba types a call in compiled code by, see `numba.core.dispatcher`."""
        signature, args = self._compiler.fold_argument_types(args, kws)
        args = tuple(map(unliteral, args))
        if args not in self._parts:
            self._parts[args] = self._lower(args)
        name, part = self.py_func.__name__, self._parts[args]
        template = make_concrete_template(name, name, [part.signature])
        return template, signature, args, {}

    def get_overload(self, sig: Any) -> object:
        """Return the key of the code for a call in compiled code."""
        args, _ = normalize_signature(sig)
        return self._parts[args].fndesc

    def _lower(self, args: tuple[Any, ...]) -> CompileResult:
        """Lower the function for argument types, as part of its callers."""
        flags, context = Flags(), self.targetctx
        self.targetdescr.options.parse_as_flags(flags, self.targetoptions)
        flags.no_compile = flags.no_cpython_wrapper = True
        library = _Part(context.codegen(), self.py_func.__qualname__)
        part = compile_extra(
            self.typingctx, context, self.py_func, args, None, flags, {}, library=library
        )
        context.insert_user_function(part.fndesc, part.fndesc, library.with_callees())
        return part


class _Part(JITCodeLibrary):
    """Code that is optimised and translated as part of an entry point."""

    def finalize(self) -> None:
        """Leave the code as it was lowered."""
        self._finalized = True

    def with_callees(self) -> list[Any]:
        """Return this code and that of all functions called, directly or not."""
        return list(dict.fromkeys([self, *self._linking_libraries]))
