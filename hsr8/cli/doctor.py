"""``hsr8 doctor``: is everything in place?"""

import os
import platform
import shutil
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from hsr8.cli.options import Doctor
from hsr8.errors import Hsr8Error
from hsr8.gl import APT_LINE, BACKENDS, REQUESTED, VULKAN_LINE, is_software
from hsr8.recorder.files import atomic
from hsr8.recorder.run.manifest import versions
from hsr8.render import viewer
from hsr8.version import VERSION
from hsr8.world.model.models import models_dir

PROBE_LIMIT = 60.0  # an OpenGL that needs longer hangs [s]
VULKAN_FOLDERS = ("/usr/share", "/usr/local/share", "/etc")
LEAST_DISK = 1.0  # [GB]
PROBE = "from hsr8.gl import require_gl; print(require_gl())"


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing looked at.

    Attributes:
        name: what.
        state: ok, note or missing.
        text: what was found, and what to do.
    """

    name: str
    state: str
    text: str


def main(options: Doctor) -> int:
    """Look and report; 0 when a full run can be made here, else 2."""
    findings = examine()
    if options.json:
        print(atomic.dumps({"findings": [asdict(finding) for finding in findings]}))
    else:
        _show(findings)
    return 2 if any(finding.state == "missing" for finding in findings) else 0


def examine() -> list[Finding]:
    """Everything `hsr8` needs."""
    return [
        Finding("hsr8", "ok", f"{VERSION}, {sys.prefix}"),
        Finding("Python", "ok", f"{platform.python_version()}, {platform.platform()}"),
        *(
            Finding(name, "missing" if version == "missing" else "ok", version)
            for name, version in versions().items()
        ),
        *opengl({backend: probe(backend) for backend in BACKENDS}),
        *_asked(REQUESTED),
        _models(),
        _disk(),
        _viewer(),
    ]


def probe(backend: str) -> str | None:
    """Renderer of a backend, tried in a process of its own; None if it does not draw."""
    environment = os.environ | {"MUJOCO_GL": backend}
    environment.pop("PYOPENGL_PLATFORM", None)
    try:
        tried = subprocess.run(
            [sys.executable, "-P", "-c", PROBE],
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
    """What the probes of all backends mean."""
    findings = []
    for backend, renderer in renderers.items():
        if renderer is None:
            findings.append(Finding(f"OpenGL {backend}", "note", "does not draw here"))
        elif is_software(renderer):
            findings.append(
                Finding(
                    f"OpenGL {backend}",
                    "ok",
                    f"{renderer}: drawn on the processor, enough for the head camera; "
                    "videos take a minute or two",
                )
            )
        else:
            findings.append(Finding(f"OpenGL {backend}", "ok", renderer))
    if not any(renderers.values()):
        findings.append(
            Finding(
                "OpenGL",
                "missing",
                f"nothing draws; as root: {APT_LINE}   (or run with --camera analytic)",
            )
        )
    return findings


def _asked(backend: str) -> list[Finding]:
    """Whether the backend that the user's environment asks for draws."""
    if not backend:
        return []
    name = f"MUJOCO_GL={backend}"
    renderer = probe(backend)
    if renderer is None:
        return [Finding(name, "missing", "is set, but does not draw here: unset MUJOCO_GL")]
    return [Finding(name, "ok", f"is set and draws: {renderer}")]


def _models() -> Finding:
    try:
        return Finding("models", "ok", str(models_dir()))
    except Hsr8Error as error:
        return Finding("models", "missing", str(error))


def _disk() -> Finding:
    free = shutil.disk_usage(Path.cwd()).free / 1e9
    text = f"{free:.1f} GB free here; a run of ten minutes takes about 0.15 GB"
    return Finding("disk", "ok" if free >= LEAST_DISK else "note", text)


def _viewer() -> Finding:
    try:
        found = viewer.executable()
    except Hsr8Error as error:
        return Finding("Rerun viewer", "note", str(error))
    text = f"{found}; hsr8 binds it to 127.0.0.1 only"
    if not _vulkan_drivers():
        return Finding("Rerun viewer", "note", f"{text}; it draws with Vulkan: {VULKAN_LINE}")
    return Finding("Rerun viewer", "ok", text)


def _vulkan_drivers() -> list[Path]:
    return [
        file for folder in VULKAN_FOLDERS for file in Path(folder, "vulkan/icd.d").glob("*.json")
    ]


def _show(findings: list[Finding]) -> None:
    marks = {"ok": "[green]ok[/]", "note": "[yellow]note[/]", "missing": "[red]missing[/]"}
    table = Table("", "", "", show_header=False, box=None, padding=(0, 2, 0, 0))
    for finding in findings:
        table.add_row(marks[finding.state], finding.name, escape(finding.text))
    Console(highlight=False).print(table)
