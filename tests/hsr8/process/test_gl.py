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
        (("EGL", "OSMesa"), "glfw", "glfw"),
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


def test_physics_works_without_opengl():
    """The import of MuJoCo survives a backend whose library is missing."""
    code = "import hsr8, mujoco; mujoco.MjModel.from_xml_string('<mujoco/>')"
    environment = os.environ | {"MUJOCO_GL": "disable"}
    subprocess.run([sys.executable, "-c", code], env=environment, check=True, timeout=60)


def _run(camera, queue):
    try:
        settings = {"robot.body": "kinematic", "camera.source": camera, "duration": 0.1}
        queue.put((hsr8.run("quick", settings=settings).exit_reason, 0))
    except RenderingUnavailable as error:
        queue.put((str(error), error.exit_code))


@pytest.mark.gl
@pytest.mark.parametrize(("camera", "code"), [("rendered", 2)])
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
