"""Check every further supported Python of this machine, each in its own environment.

    python scripts/check_interpreters.py

Interpreters are those on PATH and those of pyenv. For each of them an environment ``.venv-3.X`` is
set up; it runs `quick` with camera and log, exports that run, sweeps two seeds and runs the system
tests. The state hash of the run must be that of the Python that runs this script.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from time import perf_counter

from packaging.specifiers import SpecifierSet

ROOT = Path(__file__).resolve().parents[1]
PYENV = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
VERSIONS = [f"3.{minor}" for minor in range(10, 30)]
HASHED = ("quick", "--seed", "2", "--duration", "6")  # with full physics and rendered camera
VERDICTS = (0, 1)  # exit codes of runs that end, with success or without
STAND_INS = ("--body", "kinematic", "--camera", "analytic")


def interpreters() -> dict[str, Path]:
    """Return the interpreter of every supported version but this one, by version."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    this = f"{sys.version_info.major}.{sys.version_info.minor}"
    supported = SpecifierSet(project["requires-python"])
    paths = {v: _interpreter(v) for v in VERSIONS if v != this and v in supported}
    return {version: path for version, path in paths.items() if path is not None}


def _interpreter(version: str) -> Path | None:
    """Return an interpreter of a version that starts, None without one."""
    candidates = sorted(PYENV.glob(f"versions/{version}.*/bin/python"))
    if (name := shutil.which(f"python{version}")) is not None:
        candidates.append(Path(name))
    for candidate in reversed(candidates):  # a shim of pyenv may name a version that is not active
        code = "import sys, ensurepip, venv; print(*sys.version_info[:2], sep='.')"
        done = subprocess.run([candidate, "-c", code], capture_output=True, text=True, check=False)
        if done.stdout.strip() == version:
            return candidate
    return None


def check(version: str, interpreter: Path, expected: str) -> None:
    """Set up an environment, use it, and compare its state hash.

    Raises:
        SystemExit: a step failed or the state hash differs.
    """
    environment = ROOT / f".venv-{version}"
    variables = os.environ | {"VENV": environment.name, "PYTHON": str(interpreter)}
    _step(f"{version}: setup", ["bash", "scripts/setup.sh"], variables)
    python = environment / "bin" / "python"
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        state = state_hash(python, out, version)
        (run,) = (out / "runs" / "quick").iterdir()
        formats = [f"--{name}={out / name}" for name in ("bag", "csv", "lerobot")]
        hsr8 = [str(python), "-m", "hsr8"]
        _step(f"{version}: exports", [*hsr8, "export", str(run), *formats])
        sweep = ["sweep", "quick", "--seeds", "0:2", *STAND_INS, "--out", str(out / "sweep")]
        _step(f"{version}: sweep", [*hsr8, *sweep], codes=VERDICTS)
    tests = ["-m", "pytest", "-q", "-n", "2", "--dist", "loadfile", "tests/system"]
    _step(f"{version}: system tests", [str(python), *tests])
    if state != expected:
        raise SystemExit(f"{version}: other state hash, got {state}; expected {expected}")


def state_hash(python: Path, out: Path, version: str) -> str:
    """Run `HASHED` with a log and return its state hash."""
    words = ["run", *HASHED, "--log", "--quiet", "--out", str(out / "runs")]
    _step(f"{version}: run", [str(python), "-m", "hsr8", *words], codes=VERDICTS)
    (file,) = out.glob("runs/*/*/metrics.json")
    assert (file.parent / "log.rrd").stat().st_size
    return str(json.loads(file.read_text())["state_hash"])


def _step(
    label: str,
    words: list[str],
    variables: dict[str, str] | None = None,
    codes: tuple[int, ...] = (0,),
) -> None:
    """Run a command and print its wall time, with its output if it fails."""
    begin = perf_counter()
    done = subprocess.run(
        words,
        cwd=ROOT,
        env=variables,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    if done.returncode not in codes:
        raise SystemExit(f"{done.stdout}\n{label}: exit code {done.returncode}")
    print(f"   {label}, {perf_counter() - begin:.0f} s", flush=True)


def main() -> None:
    others = interpreters()
    if not others:
        print(f"no other supported Python than {sys.version.split()[0]} here")
        return
    this = ".".join(map(str, sys.version_info[:2]))
    with tempfile.TemporaryDirectory() as folder:
        expected = state_hash(Path(sys.executable), Path(folder), this)
    for version, interpreter in others.items():
        print(f":: Python {version}: {interpreter}", flush=True)
        check(version, interpreter, expected)
    print(f"state hash of {', '.join([this, *others])}: {expected[:16]}")


if __name__ == "__main__":
    main()
