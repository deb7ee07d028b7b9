"""User-defined planners, gazes and walkers in Python files, named as ``FILE.py:CLASS``."""

import ast
import hashlib
import sys
from pathlib import Path
from traceback import extract_tb
from types import ModuleType
from typing import TYPE_CHECKING, Any

from hsr8.errors import UsageError
from hsr8.files.text import read_bytes

if TYPE_CHECKING:  # the command line imports this module for its errors alone
    from hsr8.scenario.plugin import Plugin

PREFIX = "plugin "  # of module names; with the space, no import statement can name them


def load_plugin(reference: str) -> Any:
    """Return a new instance of the class that ``FILE.py:CLASS`` names, made without arguments.

    The file is executed once per process; it may import modules from its folder.

    Raises:
        UsageError: the file or class does not exist or raises an error; the message names the
            line.
    """
    path, _, name = reference.rpartition(":")
    file = Path(path).resolve()
    module = _module(reference, file)
    plugin = getattr(module, name, None)
    if not isinstance(plugin, type):
        classes = [v for v in vars(module).values() if isinstance(v, type)]
        names = [c.__name__ for c in classes if c.__module__ == module.__name__]
        expected = ", ".join(names) or "a class"
        raise UsageError(f"{reference}: {path} has no class {name}; expected {expected}")
    try:
        return plugin()
    except Exception as error:
        raise UsageError(f"{reference}: {name}() failed: {_described(error, file)}") from error


def load_named(plugin: "Plugin", kind: str) -> Any:
    """Return a new instance of a plugin that a scenario names; None if it names none.

    Code runs only if a person named it: on the command line, in Python, in a scenario file that
    they gave by path and that has the code below its folder, or by trust in the files.

    Args:
        plugin: section of the scenario.
        kind: planner, gaze or walker.

    Raises:
        UsageError: it may not run, or as of `load_plugin`.
    """
    reference = plugin.named.get(kind)
    if reference is None:
        return None
    if kind in plugin.untrusted:
        raise UsageError(
            f"{plugin.untrusted[kind]}: names code that would run, got {reference}; "
            "expected --trust (in Python, trust=True) if you trust it"
        )
    return load_plugin(reference)


def require_plugins(plugin: "Plugin") -> None:
    """Check that the plugins of a scenario may run and can be instantiated.

    Raises:
        UsageError: as `load_named`.
    """
    for kind in plugin.named:
        load_named(plugin, kind)


def inspect_plugins(plugin: "Plugin") -> None:
    """Check the plugins of a scenario without running them: files, syntax, names of the classes.

    Raises:
        UsageError: a file cannot be read, is not Python, or does not define the class.
    """
    for reference in plugin.named.values():
        path, _, name = reference.rpartition(":")
        try:
            nodes = list(ast.walk(ast.parse(_content(reference))))
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            raise UsageError(f"{reference}: {path} is not Python: {_one_line(error)}") from None
        classes = [node.name for node in nodes if isinstance(node, ast.ClassDef)]
        imported = [alias.asname or alias.name for node in nodes for alias in _aliases(node)]
        assigned = [node.id for node in nodes if isinstance(node, ast.Name)]
        if not {name, "*"}.intersection([*classes, *imported, *assigned]):
            expected = ", ".join(classes) or "a class"
            raise UsageError(f"{reference}: {path} has no class {name}; expected {expected}")


def digests(plugin: "Plugin") -> dict[str, str]:
    """Return the first 12 digits of the SHA-256 of each plugin file, by reference.

    Raises:
        UsageError: a file cannot be read.
    """
    names = plugin.named.values()
    return {name: hashlib.sha256(_content(name)).hexdigest()[:12] for name in names}


def start_plugin(plugin: object, name: str, argument: object) -> None:
    """Call the optional method `start` of a plugin.

    Args:
        plugin: user-defined object.
        name: name of the plugin, for messages.
        argument: argument of the method.

    Raises:
        UsageError: the method failed.
    """
    start = getattr(plugin, "start", None)
    if start is None:
        return
    try:
        start(argument)
    except Exception as error:
        line = line_of(error)
        where = f" ({line})" if line else ""
        raise UsageError(f"{name}: start failed: {_one_line(error)}{where}") from error


def line_of(error: BaseException) -> str | None:
    """Return the plugin's file and line that raised `error`; None if no plugin did."""
    files = {str(name).removeprefix(PREFIX) for name in sys.modules if name.startswith(PREFIX)}
    frames = [f for f in extract_tb(error.__traceback__) if f.filename in files]
    return f"{frames[-1].filename}, line {frames[-1].lineno}" if frames else None


def _content(reference: str) -> bytes:
    file = reference.rpartition(":")[0]
    try:
        return read_bytes(file)
    except OSError as error:
        raise UsageError(f"{reference}: cannot read {file}: {error.strerror}") from error


def _aliases(node: ast.AST) -> list[ast.alias]:
    return node.names if isinstance(node, ast.Import | ast.ImportFrom) else []


def _module(reference: str, file: Path) -> ModuleType:
    """The module of a file, executed at the first call."""
    name = f"{PREFIX}{file}"
    if name in sys.modules:
        return sys.modules[name]
    content = _content(reference)
    module = ModuleType(name)
    module.__file__ = str(file)
    if str(file.parent) not in sys.path:
        sys.path.append(str(file.parent))
    sys.modules[name] = module  # dataclasses look for their module there
    try:
        exec(compile(content, file, "exec"), vars(module))  # bytecode on disk may be older
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        raise UsageError(f"{reference}: {file.name} failed: {_described(error, file)}") from error
    return module


def _described(error: BaseException, file: Path) -> str:
    """An exception in one line, with the line of `file` that raised it."""
    lines = [f.lineno for f in extract_tb(error.__traceback__) if f.filename == str(file)]
    where = f" (line {lines[-1]})" if lines else ""
    return f"{_one_line(error)}{where}"


def _one_line(error: BaseException) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"
