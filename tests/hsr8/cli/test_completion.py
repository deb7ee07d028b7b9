import shutil
import subprocess

import pytest

from hsr8.cli.main import COMMANDS, entry


@pytest.mark.parametrize("shell", ["bash", "zsh"])
def test_every_command_is_completed(shell, capsys):
    assert entry(["completion", shell]) == 0
    script = capsys.readouterr().out
    for name in COMMANDS:
        assert name in script


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash here")
def test_bash_understands_its_script(capsys):
    entry(["completion", "bash"])
    script = capsys.readouterr().out
    checked = subprocess.run(
        ["bash", "-n"], input=script, text=True, capture_output=True, check=False, timeout=30
    )
    assert (checked.returncode, checked.stderr) == (0, "")


def test_another_shell_is_a_usage_error(capsys):
    assert entry(["completion", "cmd"]) == 2
