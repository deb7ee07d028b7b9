"""Digest of the program's files, for manifests, sweeps and result pages."""

import hashlib
from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from hsr8.robots.file.files import models_dir

PACKAGES = ("compilation", "hsr8", "navigation", "walking", "vision")
# Folders and files of hsr8 that influence no run:
NOT_IN_DIGEST = ("cli", "show", "export", "sweep", "measure/registry", "_models")


@cache
def code_digest() -> str:
    """Return the first digits of the SHA-256 of all files that influence a result.

    It is computed once per process: the code that runs does not follow later changes of the files.
    """
    digest = hashlib.sha256()
    for name, file in _files():
        digest.update(name.encode() + b"\0" + hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()[:12]


def _files() -> Iterator[tuple[str, Path]]:
    for package in PACKAGES:
        spec = find_spec(package)
        assert spec is not None, package
        assert spec.origin is not None, package
        root = Path(spec.origin).parent
        for file in sorted(root.rglob("*.py")):
            name = file.relative_to(root).as_posix()
            if package != "hsr8" or not name.startswith(NOT_IN_DIGEST):
                yield f"{package}/{name}", file
    root = models_dir()
    for file in sorted(root.rglob("*")):
        if file.is_file() and file.suffix not in (".py", ".pyc", ".md"):
            yield f"models/{file.relative_to(root).as_posix()}", file
