"""``hsr8 doctor``: check of the installation."""

import os
import platform
import shutil
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter

from hsr8.cli.options import Doctor
from hsr8.errors import Hsr8Error
from hsr8.files import atomic
from hsr8.process.gl import APT_LINE, BACKENDS, REQUESTED, VULKAN_LINE, is_software
from hsr8.recording.manifest import versions
from hsr8.robots.file.files import models_dir
from hsr8.show import viewer
from hsr8.version import VERSION

PROBE_LIMIT = 60.0  # an OpenGL backend that takes longer hangs [s]
VULKAN_FOLDERS = ("/usr/share", "/usr/local/share", "/etc")
MIN_DISK = 1.0  # free space without a note [GB]
PROBE = "from hsr8.process.gl import require_gl; print(require_gl())"


@dataclass(frozen=True, slots=True)
class Finding:
    """One checked part of the installation.

    Attributes:
        name: the part.
        state: ok, note or missing.
        text: version or path of the part, or the remedy.
    """

    name: str
    state: str
    text: str


def main(options: Doctor) -> int:
    """Report the findings; return 0 if a full run can be made, else 2."""
    findings = [
        *examine(),
        *([_compiled_code(quiet=options.json)] if options.compile else []),
    ]
    if options.json:
        print(atomic.dumps({"findings": [asdict(finding) for finding in findings]}))
    else:
        for finding in findings:
            print(f"{finding.state:<9}{finding.name:<24}{finding.text}")
    return 2 if any(finding.state == "missing" for finding in findings) else 0


def examine() -> list[Finding]:
    """Return the findings of all parts that `hsr8` needs."""
    libraries = versions().items()
    return [
        Finding("hsr8", "ok", f"{VERSION}, {sys.prefix}"),
        *copied_checkout(Path(__file__).parents[2], Path.cwd()),
        Finding("Python", "ok", f"{platform.python_version()}, {platform.platform()}"),
        *(Finding(name, "missing" if v == "missing" else "ok", v) for name, v in libraries),
        *opengl({backend: probe(backend) for backend in BACKENDS}),
        *_requested_opengl(REQUESTED),
        _models(),
        _speed(),
        _disk(),
        _viewer(),
    ]


def copied_checkout(installed: Path, folder: Path) -> list[Finding]:
    """Return a finding if a folder is in a checkout of which another copy is installed.

    Args:
        installed: parent of the package that runs.
        folder: current folder.
    """
    for parent in (folder, *folder.parents):
        if (parent / "hsr8" / "cli" / "doctor.py").is_file():
            if parent.samefile(installed):
                return []
            text = f"runs from {installed}, changes in {parent} do nothing: pip install -e ."
            return [Finding("checkout", "note", text)]
    return []


def probe(backend: str) -> str | None:
    """Return the renderer of a backend, tried in another process; None if it does not draw."""
    environment = os.environ | {"MUJOCO_GL": backend}
    environment.pop("PYOPENGL_PLATFORM", None)
    command = [sys.executable, "-P", "-c", PROBE]
    try:
        tried = subprocess.run(
            command,
            env=environment,
            capture_output=True,
            text=True,
            timeout=PROBE_LIMIT,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return None
    lines = tried.stdout.strip().splitlines()
    return lines[-1] if tried.returncode == 0 and lines else None


def opengl(renderers: dict[str, str | None]) -> list[Finding]:
    """Return the findings of the renderers by backend; one of them is enough."""
    findings = []
    for backend, renderer in renderers.items():
        state, text = "ok", str(renderer)
        if renderer is None:
            state, text = "note", "does not draw here"
        elif is_software(renderer):
            text += ": draws on the processor; a video takes one to two times its length"
        findings.append(Finding(f"OpenGL {backend}", state, text))
    if not any(renderers.values()):
        remedy = f"nothing draws; as root: {APT_LINE}   (or run with --camera analytic)"
        findings.append(Finding("OpenGL", "missing", remedy))
    return findings


def _requested_opengl(backend: str) -> list[Finding]:
    """Check the backend that the environment requests, if it does."""
    if not backend:
        return []
    name, renderer = f"MUJOCO_GL={backend}", probe(backend)
    if renderer is None:
        return [Finding(name, "missing", "is set, but does not draw here: unset MUJOCO_GL")]
    return [Finding(name, "ok", f"is set and draws: {renderer}")]


def _compiled_code(*, quiet: bool) -> Finding:
    """Compile the functions that are not on disk."""
    from hsr8.cli.first_compilation import compile_all  # noqa: PLC0415  loads MuJoCo

    started = perf_counter()
    compiled = compile_all(quiet=quiet)
    text = "all compiled before"
    if compiled:
        text = f"compiled in {perf_counter() - started:.0f} s"
    return Finding("compiled code", "ok", text)


def _models() -> Finding:
    try:
        return Finding("models", "ok", str(models_dir()))
    except Hsr8Error as error:
        return Finding("models", "missing", str(error))


def _speed() -> Finding:
    """Measure the machine by a physics step of the standing robot."""
    from hsr8.cli.yardstick import course_speed, step_time  # noqa: PLC0415  loads MuJoCo

    try:
        step = step_time()
    except Hsr8Error as error:
        return Finding("speed", "note", str(error).splitlines()[0])
    expected = f"expect `course` at about {course_speed(step):.2g} times real time"
    return Finding("speed", "ok", f"{step:.1f} us for a physics step: {expected}")


def _disk() -> Finding:
    free = shutil.disk_usage(Path.cwd()).free / 1e9
    text = f"{free:.1f} GB free here; a run of ten minutes takes about 0.15 GB"
    return Finding("disk", "ok" if free >= MIN_DISK else "note", text)


def _viewer() -> Finding:
    try:
        text = f"{viewer.executable()}; bound to 127.0.0.1 only"
    except Hsr8Error as error:
        return Finding("Rerun viewer", "note", str(error))
    if not any(any(Path(folder, "vulkan/icd.d").glob("*.json")) for folder in VULKAN_FOLDERS):
        return Finding("Rerun viewer", "note", f"{text}; it draws with Vulkan: {VULKAN_LINE}")
    return Finding("Rerun viewer", "ok", text)
