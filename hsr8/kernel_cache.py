"""Folder in which Numba caches compiled kernels.

Numba caches them next to the sources, else in a cache folder of the user, and fails to import a
kernel if it can write to neither. The package calls `choose_kernel_cache` before it imports
Numba, so that a read-only checkout works.
"""

import os
import stat
import tempfile
from pathlib import Path

VARIABLE = "NUMBA_CACHE_DIR"
FOLDERS = ("hsr8/world/body", "navigation/belief", "vision", "walking/gait")  # with kernels
_ROOT = Path(__file__).resolve().parents[1]


def choose_kernel_cache(root: Path = _ROOT) -> str:
    """Set ``NUMBA_CACHE_DIR`` if Numba itself would find no writable folder.

    Args:
        root: folder of the libraries.

    Returns:
        The folder in force; empty if Numba chooses it.
    """
    if os.environ.get(VARIABLE):
        return os.environ[VARIABLE]
    user = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "numba"
    caches = (root / folder / "__pycache__" for folder in FOLDERS)
    if all(map(_writable, caches)) or _writable(user):
        return ""
    os.environ[VARIABLE] = _temporary()
    return os.environ[VARIABLE]


def _writable(folder: Path) -> bool:
    """Return whether files can be written into a folder, which may not exist yet."""
    existing = folder
    while not existing.exists():
        existing = existing.parent
    return existing.is_dir() and os.access(existing, os.W_OK | os.X_OK)


def _temporary() -> str:
    """Return a temporary folder that only this user can write to, since code is loaded from it."""
    folder = Path(tempfile.gettempdir()) / f"hsr8-kernels-{os.getuid()}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        status = folder.lstat()
        owned = stat.S_ISDIR(status.st_mode) and status.st_uid == os.getuid()
        if owned and not status.st_mode & (stat.S_IRWXG | stat.S_IRWXO):
            return str(folder)
    except OSError:
        pass
    return tempfile.mkdtemp(prefix="hsr8-kernels-")
