"""The Dockerfile names only files, packages and commands that exist."""

import re
import shlex
import tomllib
from pathlib import Path

import pytest

from hsr8.cli.main import parse
from hsr8.gl import APT_LINE, BACKENDS

ROOT = Path(__file__).parents[1]
IGNORED = {line.rstrip("/") for line in (ROOT / ".dockerignore").read_text().splitlines()}


def instructions():
    """Return the name and the words of each instruction."""
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    text = "\n".join(line for line in text.splitlines() if not line.lstrip().startswith("#"))
    lines = text.replace("\\\n", " ").splitlines()
    return [(line.split()[0], shlex.split(line)[1:]) for line in lines if line.strip()]


def words(name):
    return [arguments for instruction, arguments in instructions() if instruction == name]


def commands():
    """Return the commands of all RUN instructions."""
    for line in words("RUN"):
        command = []
        for word in [*line, "&&"]:
            if word == "&&":
                yield command
                command = []
            else:
                command.append(word)


def test_the_base_is_pinned_to_a_supported_python():
    bases = {arguments[0] for arguments in words("FROM")}
    assert len(bases) == 1
    version = re.fullmatch(r"python:(3\.\d+)\.\d+-slim-bookworm", bases.pop())[1]
    classifiers = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    low, high = re.fullmatch(r">=3\.(\d+),<3\.(\d+)", classifiers["requires-python"]).groups()
    assert int(low) <= int(version.split(".")[1]) < int(high)


def test_the_files_exist_and_are_sent_to_the_build():
    assert [arguments[0] for arguments in words("COPY") if "--from=build" not in arguments] == ["."]
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    wheel = project["tool"]["hatch"]["build"]["targets"]["wheel"]["only-include"]
    metadata = [project["project"]["readme"], *project["project"]["license-files"]]
    sed = next(command for command in commands() if command[0] == "sed")
    for name in [*wheel, *metadata, "pyproject.toml", sed[3]]:
        assert (ROOT / name).exists(), name
        assert name not in IGNORED, name


def test_the_constraints_pin_every_package_once():
    """The lines that the build removes from the lock are the hashes."""
    sed = next(command for command in commands() if command[0] == "sed")
    assert sed[2] == r"/--hash/d; s/ *\\$//"
    text = (ROOT / sed[3]).read_text(encoding="utf-8")
    kept = [re.sub(r" *\\$", "", line) for line in text.splitlines() if "--hash" not in line]
    pins = [line for line in kept if line.strip() and not line.lstrip().startswith("#")]
    assert len(pins) > 50
    assert all(re.match(r"[a-z0-9-]+==\S+( ; .+)?$", line) for line in pins)


def test_the_packages_are_those_of_the_doctor_and_of_pinocchio():
    (install,) = [command for command in commands() if command[:2] == ["apt-get", "install"]]
    packages = {word for word in install[2:] if not word.startswith("-")}
    assert packages == {*APT_LINE.split()[3:], "libgomp1"}


def test_the_commands_of_hsr8_are_valid():
    entry = words("ENTRYPOINT")[0][0].strip("[]")
    hsr8 = [command[1:] for command in commands() if command[0] == entry == "hsr8"]
    assert hsr8 == [["doctor", "--compile"]]
    assert parse(hsr8[0]).compile


def test_the_user_is_not_root_and_can_write_the_kernels():
    order = [name for name, _ in instructions()]
    (user,) = words("USER")
    assert user[0] in next(command for command in commands() if command[0] == "useradd")
    compiling = max(k for k, (name, line) in enumerate(instructions()) if "--compile" in line)
    assert order.index("USER") < compiling
    variables = dict(word.split("=", 1) for line in words("ENV") for word in line)
    owned = next(command for command in commands() if command[0] == "install")
    assert variables["NUMBA_CACHE_DIR"] in owned
    assert variables["MUJOCO_GL"] in BACKENDS


@pytest.mark.parametrize(
    "line", re.findall(r"^docker .*", (ROOT / "docs/install.md").read_text(), re.M)
)
def test_the_page_has_valid_commands(line):
    arguments = shlex.split(line, comments=True)
    if arguments[1] == "build":
        assert arguments[2:] == ["-t", "hsr8", "."]
    else:
        assert arguments[1] == "run"
        assert parse(arguments[arguments.index("hsr8") + 1 :])
