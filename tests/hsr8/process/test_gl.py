import multiprocessing
import os
import subprocess
import sys

import pytest

import hsr8
from hsr8.errors import RenderingUnavailable
from hsr8.process import gl


@pytest.fixture
def libraries(monkeypatch):
    """Pretend that only these libraries can be loaded."""

    def pretend(*names):
        monkeypatch.setattr(gl, "_loads", lambda library: any(n in library for n in names))
        monkeypatch.delenv("MUJOCO_GL", raising=False)

    return pretend


@pytest.mark.parametrize(
    ("present", "requested", "chosen"),
    [
        (("EGL", "OSMesa"), "", "egl"),
        (("OSMesa",), "", "osmesa"),
        ((), "", "disable"),
        (("EGL", "OSMesa"), "osmesa", "osmesa"),
        (("EGL", "OSMesa"), "glfw", "glfw"),
        (("EGL", "OSMesa"), "disable", "disable"),
        (("EGL",), "EGL ", "egl"),
        (("EGL",), "osmesa", "disable"),  # with a missing library the import would fail
        (("EGL",), "bogus", "disable"),
    ],
)
def test_backend_follows_the_request_and_the_libraries(
    libraries, monkeypatch, present, requested, chosen
):
    libraries(*present)
    if requested:
        monkeypatch.setenv("MUJOCO_GL", requested)
    assert gl.choose_backend() == chosen
    assert os.environ["MUJOCO_GL"].strip().lower() in {chosen, requested}


@pytest.mark.parametrize(
    ("requested", "expected", "unexpected"),
    [("", gl.APT_LINE, "unset MUJOCO_GL"), ("osmesa", "unset MUJOCO_GL", gl.APT_LINE)],
)
def test_missing_opengl_names_the_remedy(libraries, monkeypatch, requested, expected, unexpected):
    libraries()
    monkeypatch.setenv("MUJOCO_GL", requested)
    monkeypatch.setattr(gl, "REQUESTED", requested)
    with pytest.raises(RenderingUnavailable, match=f"^(MUJOCO_GL={requested})?") as caught:
        gl.probe_gl()
    message = str(caught.value)
    assert expected in message
    assert unexpected not in message
    assert "--camera analytic" in message
    assert caught.value.exit_code == 2


def test_physics_works_without_opengl():
    """The import of MuJoCo survives a backend whose library is missing."""
    code = "import hsr8, mujoco; mujoco.MjModel.from_xml_string('<mujoco/>')"
    environment = os.environ | {"MUJOCO_GL": "disable"}
    subprocess.run([sys.executable, "-c", code], env=environment, check=True, timeout=60)


def test_software_renderers_are_recognised():
    assert gl.is_software("llvmpipe (LLVM 15.0.6, 256 bits)")
    assert not gl.is_software("NVIDIA H200/PCIe/SSE2")


def test_a_window_without_a_display_is_one_error():
    code = "from hsr8.process import gl; gl.require_gl()"
    environment = {k: v for k, v in os.environ.items() if "DISPLAY" not in k}
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=environment | {"MUJOCO_GL": "glfw"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert "RenderingUnavailable: MUJOCO_GL=glfw: OpenGL cannot render" in done.stderr
    assert "imported before" not in done.stderr
    assert "GLFWError" not in done.stderr


def _run(camera, queue):
    try:
        settings = {"robot.body": "kinematic", "camera.source": camera, "duration": 0.1}
        queue.put((hsr8.run("quick", settings=settings).exit_reason, 0))
    except RenderingUnavailable as error:
        queue.put((str(error), error.exit_code))


@pytest.mark.gl
@pytest.mark.parametrize(("camera", "code"), [("rendered", 2), ("analytic", 0)])
def test_rendering_after_a_fork_is_an_error_instead_of_a_hang(camera, code):
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    _run("rendered", queue)
    assert queue.get(timeout=10) == ("timeout", 0)
    child = context.Process(target=_run, args=(camera, queue))
    child.start()
    try:
        message, exit_code = queue.get(timeout=60)
    finally:
        child.kill()
        child.join()
    assert exit_code == code
    if code:
        assert "forkserver" in message
        assert "spawn" in message
