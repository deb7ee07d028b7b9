"""Planners and gazes in files of one's own, named as ``FILE.py:CLASS``."""

import hashlib
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from traceback import extract_tb
from types import ModuleType
from typing import TYPE_CHECKING, Any

from hsr8.errors import UsageError

if TYPE_CHECKING:  # the command line imports this module for its errors alone
    from hsr8.scenario.plugin import Plugin

PREFIX = "own "  # of modules' names: none that an import could mean


def load_plugin(reference: str) -> Any:
    """A new object of the class that ``FILE.py:CLASS`` names, made without arguments.

    The file is run once in a process, as by ``import``; what lies beside it can be imported.

    Raises:
        UsageError: there is no such file or class, or it cannot be run or made.
    """
    path, _, name = reference.rpartition(":")
    file = Path(path).resolve()
    module = _module(reference, file)
    made = getattr(module, name, None)
    if not isinstance(made, type):
        classes = [v for v in vars(module).values() if isinstance(v, type)]
        there = [c.__name__ for c in classes if c.__module__ == module.__name__]
        listed = ", ".join(there) or "none at all"
        raise UsageError(f"{reference}: {path} has no class {name}, but {listed}")
    try:
        return made()
    except Exception as error:  # it is somebody else's code
        raise UsageError(f"{reference}: {name}() fails: {_told(error, file)}") from error


def require_plugins(plugin: "Plugin") -> None:
    """See to it that what a scenario names can be made.

    Raises:
        UsageError: it cannot.
    """
    for reference in plugin.named:
        load_plugin(reference)


def digests(plugin: "Plugin") -> dict[str, str]:
    """First digits of the SHA-256 of each file that a scenario names, by reference.

    Raises:
        UsageError: one cannot be read.
    """
    return {name: hashlib.sha256(_content(name)).hexdigest()[:12] for name in plugin.named}


def line_of(error: BaseException) -> str | None:
    """File and line of one's own that `error` comes from; None if it comes from elsewhere."""
    own = {str(name).removeprefix(PREFIX) for name in sys.modules if name.startswith(PREFIX)}
    lines = [f for f in extract_tb(error.__traceback__) if f.filename in own]
    return f"{lines[-1].filename}, line {lines[-1].lineno}" if lines else None


def _content(reference: str) -> bytes:
    file = reference.rpartition(":")[0]
    try:
        return Path(file).read_bytes()
    except OSError as error:
        raise UsageError(f"{reference}: cannot read {file}: {error.strerror}") from error


def _module(reference: str, file: Path) -> ModuleType:
    """The file as a module, run if this process has not run it."""
    name = f"{PREFIX}{file}"
    if name in sys.modules:
        return sys.modules[name]
    _content(reference)  # a file that is not there is told as such
    spec = spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    beside = str(file.parent)
    if beside not in sys.path:
        sys.path.append(beside)
    sys.modules[name] = module  # dataclasses look for their module there
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        raise UsageError(f"{reference}: {file.name} cannot be run: {_told(error, file)}") from error
    return module


def _told(error: BaseException, file: Path) -> str:
    """An exception in a line, with the line of `file` that it comes from."""
    lines = [f.lineno for f in extract_tb(error.__traceback__) if f.filename == str(file)]
    where = f" (line {lines[-1]})" if lines else ""
    return f"{type(error).__name__}: {' '.join(str(error).split())}{where}"
