"""OpenGL without a display: the one place that chooses how MuJoCo draws.

MuJoCo reads ``MUJOCO_GL`` once, when it is first imported. The package calls
`choose_backend` before anything of it imports MuJoCo.
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
ASKED = os.environ.get("MUJOCO_GL", "").strip()  # by the user, before `choose_backend` writes it
_LIBRARIES = {"egl": "libEGL.so.1", "osmesa": "libOSMesa.so.8"}
# What else MuJoCo takes on Linux: a window of a display, or nothing at all.
_OTHERS = {"glfw", "glx", "enable", "enabled", "on", "true", "1"}
_OTHERS |= {"disable", "disabled", "off", "false", "0"}
SOFTWARE_RENDERERS = ("llvmpipe", "softpipe", "swrast", "software")


def choose_backend() -> str:
    """Set ``MUJOCO_GL``: what the user asked for, else EGL, else OSMesa.

    A backend that is unknown or whose library is missing is switched off, for it would make
    the import of MuJoCo fail although physics needs no drawing.

    Returns:
        The backend in force.
    """
    asked = os.environ.get("MUJOCO_GL", "").strip().lower()
    if asked in _OTHERS:
        return asked
    wanted = [name for name in BACKENDS if asked in ("", name)]
    chosen = next((name for name in wanted if _loads(_LIBRARIES[name])), "disable")
    os.environ["MUJOCO_GL"] = chosen
    return chosen


@cache
def require_gl() -> str:
    """Make sure that MuJoCo can draw; asked once per process.

    Returns:
        Name of the renderer as OpenGL gives it, for example ``llvmpipe (LLVM 15.0.6, ...)``.

    Raises:
        RenderingUnavailable: no OpenGL draws here; the message says what to install.
    """
    if choose_backend() == "disable":
        raise RenderingUnavailable(_advice("no library to draw with was found"))
    import mujoco  # noqa: PLC0415  the backend is chosen first

    try:
        with warnings.catch_warnings(record=True) as said:  # GLFW's way to fail
            warnings.simplefilter("always")
            context = mujoco.GLContext(16, 16)
            context.make_current()
            from OpenGL import GL  # noqa: PLC0415  binds to the platform of the context

            name = GL.glGetString(GL.GL_RENDERER)
            context.free()
    except (ImportError, AttributeError, OSError, RuntimeError, TypeError, mujoco.FatalError) as e:
        raise RenderingUnavailable(_advice(str(e))) from e
    if name is None:
        reason = "the context does not answer; was mujoco imported before hsr8?"
        for warning in said[:1]:
            reason = re.sub(r"\(\d+\) b'(.*)'", r"\1", str(warning.message))
        raise RenderingUnavailable(_advice(reason))
    return str(name.decode())


def flush() -> None:
    """Start the queued drawing without waiting (glFlush)."""
    from OpenGL import GL  # noqa: PLC0415  binds to the platform of the context

    GL.glFlush()


def is_software(renderer: str) -> bool:
    """Whether this renderer draws on the processor."""
    return any(word in renderer.lower() for word in SOFTWARE_RENDERERS)


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _advice(reason: str) -> str:
    why = reason.splitlines()[0] if reason else "no reason given"
    if ASKED:
        cause = f"no OpenGL can draw with MUJOCO_GL={ASKED} ({why})"
        cure = f"let hsr8 choose:      unset MUJOCO_GL   (or choose {', '.join(BACKENDS)})"
    else:
        cause = f"no OpenGL can draw here ({why})"
        cure = f"install it, as root:  {APT_LINE}"
    return (
        f"{cause}"
        f"\n  {cure}"
        "\n  or run without it:    --camera analytic"
        "\n  details:              hsr8 doctor"
    )
