import os
import subprocess
import sys

import pytest

from hsr8 import gl
from hsr8.errors import RenderingUnavailable


@pytest.fixture
def libraries(monkeypatch):
    """Pretend that only these libraries can be loaded."""

    def pretend(*names):
        monkeypatch.setattr(gl, "_loads", lambda library: any(n in library for n in names))
        monkeypatch.delenv("MUJOCO_GL", raising=False)
        monkeypatch.setattr(sys, "platform", "linux")

    return pretend


@pytest.mark.parametrize(
    ("present", "chosen"),
    [(("EGL", "OSMesa"), "egl"), (("OSMesa",), "osmesa"), ((), "disable")],
)
def test_egl_comes_before_osmesa_before_nothing(libraries, present, chosen):
    libraries(*present)
    assert gl.choose_backend() == chosen
    assert os.environ["MUJOCO_GL"] == chosen


@pytest.mark.parametrize("asked", ["osmesa", "glfw", "disable"])
def test_what_the_user_asks_for_is_respected(libraries, monkeypatch, asked):
    libraries("EGL", "OSMesa")
    monkeypatch.setenv("MUJOCO_GL", asked)
    assert gl.choose_backend() == asked


def test_a_missing_library_is_not_left_to_break_the_import(libraries, monkeypatch):
    libraries("EGL")
    monkeypatch.setenv("MUJOCO_GL", "osmesa")
    assert gl.choose_backend() == "disable"


@pytest.mark.parametrize("asked", ["bogus", "EGL "])
def test_a_backend_that_does_not_exist_is_not_left_to_break_the_import(
    libraries, monkeypatch, asked
):
    libraries("EGL")
    monkeypatch.setenv("MUJOCO_GL", asked)
    assert gl.choose_backend() == ("egl" if asked == "EGL " else "disable")


def test_without_opengl_the_message_says_what_to_do(libraries, monkeypatch):
    libraries()
    monkeypatch.setattr(gl, "ASKED", "")
    with pytest.raises(RenderingUnavailable) as caught:
        gl.require_gl.__wrapped__()
    assert gl.APT_LINE in str(caught.value)
    assert "--camera analytic" in str(caught.value)
    assert caught.value.exit_code == 2


def test_a_backend_that_was_asked_for_in_vain_is_named(libraries, monkeypatch):
    libraries("EGL")
    monkeypatch.setenv("MUJOCO_GL", "osmesa")
    monkeypatch.setattr(gl, "ASKED", "osmesa")
    with pytest.raises(RenderingUnavailable, match="MUJOCO_GL=osmesa") as caught:
        gl.require_gl.__wrapped__()
    assert "unset MUJOCO_GL" in str(caught.value)
    assert gl.APT_LINE not in str(caught.value)


def test_physics_works_without_any_opengl():
    """The import of MuJoCo survives a backend whose library is missing."""
    script = "import hsr8, mujoco; mujoco.MjModel.from_xml_string('<mujoco/>')"
    environment = os.environ | {"MUJOCO_GL": "disable"}
    subprocess.run([sys.executable, "-c", script], env=environment, check=True, timeout=60)


def test_software_renderers_are_recognised():
    assert gl.is_software("llvmpipe (LLVM 15.0.6, 256 bits)")
    assert not gl.is_software("NVIDIA H200/PCIe/SSE2")


def test_a_window_without_a_display_is_one_message():
    script = "from hsr8 import gl; gl.require_gl()"
    environment = {k: v for k, v in os.environ.items() if "DISPLAY" not in k}
    done = subprocess.run(
        [sys.executable, "-c", script],
        env=environment | {"MUJOCO_GL": "glfw"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert "RenderingUnavailable: no OpenGL can draw with MUJOCO_GL=glfw" in done.stderr
    assert "imported before" not in done.stderr
    assert "GLFWError" not in done.stderr
