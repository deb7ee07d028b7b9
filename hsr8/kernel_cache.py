"""Chooses the folder where Numba caches compiled kernels.

Numba keeps them beside the sources, else in a cache folder of the user, and refuses to import a
kernel where it can write neither. The package calls `choose_kernel_cache` before anything of it
imports Numba, so that a checkout that nobody may write to works as well.
"""

import os
import stat
import tempfile
from pathlib import Path

VARIABLE = "NUMBA_CACHE_DIR"
FOLDERS = (
    "hsr8/world/body",
    "hsr8/world/camera",
    "hsr8/world/truth",
    "navigation",
    "navigation/belief",
    "navigation/motion",
    "vision",
    "walking",
    "walking/body",
    "walking/footsteps",
    "walking/gait",
    "walking/pattern",
)  # that have kernels
_ROOT = Path(__file__).resolve().parents[1]


def choose_kernel_cache(root: Path = _ROOT) -> str:
    """Set ``NUMBA_CACHE_DIR`` where Numba itself would find no place.

    Args:
        root: folder of the libraries.

    Returns:
        The folder in force; empty where Numba is to choose by itself.
    """
    if os.environ.get(VARIABLE):
        return os.environ[VARIABLE]
    user = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "numba"
    beside = (root / folder / "__pycache__" for folder in FOLDERS)
    if all(map(_writable, beside)) or _writable(user):
        return ""
    os.environ[VARIABLE] = _temporary()
    return os.environ[VARIABLE]


def _writable(folder: Path) -> bool:
    """Whether files can be written into a folder, which need not exist yet."""
    there = folder
    while not there.exists() and there != there.parent:
        there = there.parent
    return there.is_dir() and os.access(there, os.W_OK | os.X_OK)


def _temporary() -> str:
    """A folder among the temporary ones that is this user's alone: code is loaded from it."""
    folder = Path(tempfile.gettempdir()) / f"hsr8-kernels-{os.getuid()}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
        ours = stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid()
        if ours and not found.st_mode & (stat.S_IRWXG | stat.S_IRWXO):
            return str(folder)
    except OSError:
        pass
    return tempfile.mkdtemp(prefix="hsr8-kernels-")
