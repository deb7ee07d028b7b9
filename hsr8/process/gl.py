"""OpenGL without a display: choice of the backend with which MuJoCo renders.

MuJoCo reads ``MUJOCO_GL`` once, when it is first imported. The package calls `choose_backend`
before it imports MuJoCo.
"""

import ctypes
import os
import re
import warnings
from functools import cache

from hsr8.errors import RenderingUnavailable

APT_LINE = "apt-get install -y libegl1 libgl1"
VULKAN_LINE = "apt-get install -y mesa-vulkan-drivers"  # for the Rerun viewer
BACKENDS = ("egl", "osmesa")
REQUESTED = os.environ.get("MUJOCO_GL", "").strip()  # by the user, before `choose_backend`
_LIBRARIES = {"egl": "libEGL.so.1", "osmesa": "libOSMesa.so.8"}
# Other values that MuJoCo accepts on Linux: a window of a display, or no rendering.
_OTHERS = {"glfw", "glx", "enable", "enabled", "on", "true", "1"}
_OTHERS |= {"disable", "disabled", "off", "false", "0"}
SOFTWARE_RENDERERS = ("llvmpipe", "softpipe", "swrast", "software")


def choose_backend() -> str:
    """Set ``MUJOCO_GL`` to the user's choice, else to EGL, else to OSMesa.

    An unknown backend or one with a missing library is switched off: with it the import of
    MuJoCo would fail although physics does not need rendering.

    Returns:
        The backend in force.
    """
    requested = os.environ.get("MUJOCO_GL", "").strip().lower()
    if requested in _OTHERS:
        return requested
    candidates = [name for name in BACKENDS if requested in ("", name)]
    chosen = next((name for name in candidates if _loads(_LIBRARIES[name])), "disable")
    os.environ["MUJOCO_GL"] = chosen
    return chosen


def require_gl() -> str:
    """Check that MuJoCo can render in this process; OpenGL is tried once.

    Returns:
        Name of the OpenGL renderer, for example ``llvmpipe (LLVM 15.0.6, ...)``.

    Raises:
        RenderingUnavailable: OpenGL cannot render here, or was used before a fork of the process.
    """
    renderer, process = _first_use()
    if process != os.getpid():
        raise RenderingUnavailable(
            "multiprocessing start method fork: OpenGL was used before the fork and would hang in "
            "this process; expected forkserver or spawn, as in "
            "multiprocessing.get_context('forkserver')"
        )
    return renderer


@cache
def _first_use() -> tuple[str, int]:
    """Return the renderer and the process that used OpenGL first."""
    return probe_gl(), os.getpid()


def probe_gl() -> str:
    """Open an OpenGL context and return the name of the renderer.

    Raises:
        RenderingUnavailable: OpenGL cannot render here.
    """
    if choose_backend() == "disable":
        raise RenderingUnavailable(_advice("no OpenGL library"))
    import mujoco  # noqa: PLC0415  the backend is chosen first

    try:
        with warnings.catch_warnings(record=True) as caught:  # GLFW fails with a warning
            warnings.simplefilter("always")
            context = mujoco.GLContext(16, 16)
            context.make_current()
            from OpenGL import GL  # noqa: PLC0415  binds to the platform of the context

            name = GL.glGetString(GL.GL_RENDERER)
            context.free()
    except (ImportError, AttributeError, OSError, RuntimeError, TypeError, mujoco.FatalError) as e:
        raise RenderingUnavailable(_advice(str(e))) from e
    if name is None:
        reason = "the context does not respond; was mujoco imported before hsr8?"
        for warning in caught[:1]:
            reason = re.sub(r"\(\d+\) b'(.*)'", r"\1", str(warning.message))
        raise RenderingUnavailable(_advice(reason))
    return str(name.decode())


def flush() -> None:
    """Start the queued rendering without waiting (glFlush)."""
    from OpenGL import GL  # noqa: PLC0415  binds to the platform of the context

    GL.glFlush()


def is_software(renderer: str) -> bool:
    """Return whether this renderer runs on the CPU."""
    return any(word in renderer.lower() for word in SOFTWARE_RENDERERS)


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _advice(reason: str) -> str:
    why = reason.splitlines()[0] if reason else "no reason given"
    if REQUESTED:
        cause = f"MUJOCO_GL={REQUESTED}: OpenGL cannot render ({why})"
        remedy = f"let hsr8 choose:      unset MUJOCO_GL   (or choose {', '.join(BACKENDS)})"
    else:
        cause = f"OpenGL cannot render ({why})"
        remedy = f"install it, as root:  {APT_LINE}"
    return (
        f"{cause}"
        f"\n  {remedy}"
        "\n  or run without it:    --camera analytic"
        "\n  details:              hsr8 doctor"
    )
