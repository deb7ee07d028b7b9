import re
import shutil
import subprocess

import pytest

from hsr8.cli.main import COMMANDS, entry
from hsr8.cli.signature import signature

SHELLS = ("bash", "zsh", "fish")


@pytest.fixture
def script(capsys):
    """The script of a shell."""

    def printed(shell):
        assert entry(["completion", shell]) == 0
        return capsys.readouterr().out

    return printed


@pytest.mark.parametrize("shell", SHELLS)
def test_every_command_and_option_is_in_the_script(shell, script):
    words = set(re.findall(r"[a-z0-9-]+", script(shell)))
    for name, (kind, _) in COMMANDS.items():
        assert set(name.split()) <= words
        for argument in signature(kind):
            if argument.is_option:
                assert argument.word.removeprefix("--" if shell == "fish" else "") in words
            assert set(argument.choices) <= words


@pytest.mark.parametrize("shell", SHELLS)
def test_the_shell_understands_its_script(shell, script):
    if shutil.which(shell) is None:
        pytest.skip(f"no {shell} here")
    checked = subprocess.run(
        [shell, "-n"], input=script(shell), text=True, capture_output=True, check=False, timeout=30
    )
    assert (checked.returncode, checked.stderr) == (0, "")


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash here")
def test_bash_completes(script, tmp_path):
    for name in ("runs", "a yard"):
        (tmp_path / name).mkdir()
    (tmp_path / "yard.toml").touch()
    wanted = {
        "ren": "render",
        "run qui": "quick",
        "run y": "yard.toml",
        "run quick --bo": "--body",
        "run quick --body ": "full|kinematic",
        "run quick --seed ": "",
        "check rep": "replay",
        "check replay ": "a yard|runs",
        "check replay runs --": "--json|--help",
        "render runs --camera=": "",
        "plot runs --what z": "zmp",
        "doctor ": "--json|--help",
        "completion ": "bash|zsh|fish",
    }
    lines = [script("bash"), "IFS='|'"]
    for typed in wanted:
        words = " ".join(f"'{word}'" for word in ["hsr8", *typed.split(" ")])
        lines += [f"COMP_WORDS=({words}); COMP_CWORD=$(( ${{#COMP_WORDS[@]}} - 1 ))"]
        lines += ['_hsr8; echo "${COMPREPLY[*]}"']
    told = subprocess.run(
        ["bash"],
        input="\n".join(lines),
        cwd=tmp_path,
        text=True,
        capture_output=True,
        check=True,
        timeout=30,
    ).stdout.splitlines()
    found = ["|".join(sorted(line.split("|"))) for line in told]
    assert dict(zip(wanted, found, strict=True)) == {
        typed: "|".join(sorted(right.split("|"))) for typed, right in wanted.items()
    }


def test_another_shell_is_a_usage_error(capsys):
    assert entry(["completion", "cmd"]) == 2
