"""Files of compiled code, each with the digests of its sources and of its contents.

The files of a module lie in its `__pycache__`, also where that folder is read-only. Where it cannot
be written, new files go to the user's cache folder or, without one, to a private temporary folder.
`NUMBA_CACHE_DIR` replaces all of them.
"""

import hashlib
import os
import stat
import uuid
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

from numba.core import config

from compilation.sources import PACKAGES, ROOT

SUFFIX = ".compiled"
_DIGEST = 32  # length of a digest [bytes]


def load(source: Path, name: str, stamp: bytes) -> bytes | None:
    """Return the contents of the first file that is complete and fits its sources; None without.

    Args:
        source: source file of the compiled function.
        name: name of the file of compiled code.
        stamp: digest of the sources of the function.
    """
    for folder in folders(source):
        with suppress(OSError):
            content = (folder / name).read_bytes()
            if content[:_DIGEST] == stamp and _is_complete(content):
                return content[2 * _DIGEST :]
    return None


def save(source: Path, name: str, stamp: bytes, payload: bytes) -> bool:
    """Replace a file in the first folder that can be written; return whether there is one.

    Args:
        source: source file of the compiled function.
        name: name of the file of compiled code.
        stamp: digest of the sources of the function.
        payload: compiled code.
    """
    content = b"".join([stamp, hashlib.sha256(payload).digest(), payload])
    for folder in folders(source):
        draft = folder / f"{uuid.uuid4().hex}.tmp"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            draft.write_bytes(content)
            draft.replace(folder / name)
        except OSError:
            with suppress(OSError):
                draft.unlink(missing_ok=True)
            continue
        return True
    return False


def can_keep() -> bool:
    """Return whether new code of this project can be kept."""
    return any(map(_is_writable, folders(Path(__file__))))


def folders(source: Path) -> Iterator[Path]:
    """Yield the folders of the compiled code of a source file, in the order of preference."""
    if not config.CACHE_DIR:
        yield source.parent / "__pycache__"
    parent = hashlib.sha256(os.fsencode(source.resolve().parent)).hexdigest()[:16]
    for root in _roots():
        yield root / f"{source.parent.name}-{parent}"


def damaged() -> list[Path]:
    """Return the files of compiled code whose contents are incomplete or changed."""
    files = [
        *(file for package in PACKAGES for file in (ROOT / package).rglob(f"*{SUFFIX}")),
        *(file for root in _roots() for file in root.glob(f"*/*{SUFFIX}")),
    ]
    return [file for file in files if not _is_complete(file.read_bytes())]


def _is_complete(content: bytes) -> bool:
    return hashlib.sha256(content[2 * _DIGEST :]).digest() == content[_DIGEST : 2 * _DIGEST]


@cache
def _roots() -> tuple[Path, ...]:
    """Return the folders for code that does not lie next to its source; empty if none is safe."""
    if config.CACHE_DIR:
        return (Path(config.CACHE_DIR),)
    user = Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "hsr8")
    if user.is_absolute() and _is_writable(user):
        return (user,)
    return _temporary()


def _is_writable(folder: Path) -> bool:
    """Return whether files can be written into a folder, which may not exist yet."""
    existing = next(parent for parent in (folder, *folder.parents) if parent.exists())
    return existing.is_dir() and os.access(existing, os.W_OK | os.X_OK)


def _temporary() -> tuple[Path, ...]:
    """Return a temporary folder that only this user can write to, since code is loaded from it."""
    folder = Path(os.environ.get("TMPDIR") or "/tmp", f"hsr8-compiled-{os.getuid()}")
    with suppress(OSError):
        folder.mkdir(mode=0o700, exist_ok=True)
        status = folder.lstat()
        owned = stat.S_ISDIR(status.st_mode) and status.st_uid == os.getuid()
        if owned and not status.st_mode & (stat.S_IRWXG | stat.S_IRWXO):
            return (folder,)
    return ()
