"""Source files that a compiled function depends on.

Numba compiles the functions that a function calls, and the constants that it uses, into its code.
Both come from the file of the function or from a project file that it imports, directly or not.
"""

import hashlib
import re
from functools import cache
from pathlib import Path

import numba

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("compilation", "hsr8", "navigation", "vision", "walking")
_NAMES = "|".join(PACKAGES)
_IMPORT = re.compile(
    rf"^[ \t]*(?:from[ \t]+((?:{_NAMES})\b[\w.]*)[ \t]+import[ \t]+(?:\(([^)]*)\)|(.*))"
    r"|import[ \t]+(.*))",
    re.MULTILINE,
)


@cache
def stamp(file: Path) -> bytes:
    """Return a digest of a file, of the project files that it imports and of Numba's version.

    Args:
        file: source file of a compiled function.

    Returns:
        Digest of 32 bytes, equal on all machines.
    """
    digests = sorted(_read(source)[0] for source in closure(file))
    return hashlib.sha256(b"".join([numba.__version__.encode(), *digests])).digest()


def closure(file: Path) -> set[Path]:
    """Return a file and the project files that it imports, directly or not."""
    reached, waiting = {file}, [file]
    while waiting:
        new = _read(waiting.pop())[1] - reached
        reached |= new
        waiting += new
    return reached


@cache
def _read(file: Path) -> tuple[bytes, frozenset[Path]]:
    """Return the digest of a file and the project files that it names in its imports."""
    source = file.read_bytes()
    modules: set[str] = set()
    for package, in_brackets, on_line, plain in _IMPORT.findall(source.decode()):
        if plain:
            modules |= {name.split()[0] for name in plain.split(",") if name.strip()}
        else:  # a name may be that of a module
            names = re.findall(r"(\w+)[^,\n]*", in_brackets or on_line)
            modules |= {package, *(f"{package}.{name}" for name in names)}
    imported = {path for module in modules for path in _files(module)}
    return hashlib.sha256(source).digest(), frozenset(imported)


def _files(module: str) -> list[Path]:
    """Return the file of a project module; empty for another name."""
    if module.partition(".")[0] not in PACKAGES:
        return []
    path = ROOT.joinpath(*module.split("."))
    candidates = path.with_name(f"{path.name}.py"), path / "__init__.py"
    return [candidate for candidate in candidates if candidate.is_file()]
