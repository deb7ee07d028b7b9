"""hsr8 in containers that forbid almost everything: a user without a name, read-only folders.

A mount namespace of the test imitates them, which takes root.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
USER = 54321  # without an entry in /etc/passwd
NAMESPACE = r"""
set -e
mount --make-rprivate /
python=$(dirname "$(dirname "$(readlink -f "$PYTHON")")")
if [ "${python#"$PRIVATE"/}" != "$python" ]; then  # an interpreter in a private home
    mkdir -p "$WORK/python"
    mount --bind "$python" "$WORK/python"
    mount -t tmpfs -o mode=755 none "$PRIVATE"
    mkdir -p "$python"
    mount --move "$WORK/python" "$python"
fi
mount --bind "$TREE" "$TREE"
mount -o remount,bind,ro "$TREE"
mkdir -p /mnt
mount -t tmpfs -o mode=755 none /mnt
mkdir /mnt/data /mnt/current
chown "$OWNER" /mnt/data
for folder in /tmp /var/tmp /dev/shm; do
    [ -d $folder ] && mount -t tmpfs -o ro none $folder
done
cd /mnt/current
exec setpriv --reuid "$OWNER" --regid "$OWNER" --clear-groups env -i PATH=/usr/bin:/bin \
    bash -c "$COMMANDS"
"""


def in_container(commands):
    """Run shell commands as a nameless user who can write nothing but /mnt/data."""
    variables = {
        "PYTHON": sys.executable,
        "TREE": str(ROOT),
        "WORK": "/run/hsr8-test",
        "PRIVATE": str(Path.home()),
        "OWNER": str(USER),
        "COMMANDS": f'python() {{ {sys.executable} "$@"; }}; hsr8() {{ python -m hsr8 "$@"; }}; '
        + commands,
    }
    return subprocess.run(
        ["unshare", "--mount", "bash", "-c", NAMESPACE],
        env=os.environ | variables,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture(scope="module", autouse=True)
def container():
    """Skip where no such container can be made."""
    if os.getuid() != 0 or in_container("python -c 'import numpy'").returncode:
        pytest.skip("needs root, mount namespaces and setpriv")


KINEMATIC = "--body kinematic --camera analytic --duration 0.5"


@pytest.mark.timeout(600)
def test_a_run_uses_the_compiled_code_of_the_read_only_installation_and_a_plot_needs_a_folder():
    """What is missing is named in one line, with the remedy."""
    subprocess.run(  # the code of this run is in the installation
        [sys.executable, "-m", "hsr8", "run", "quick", *KINEMATIC.split(), "--quiet"],
        cwd="/tmp",
        check=False,
    )
    run = f"hsr8 run quick {KINEMATIC} --json --out /mnt/data"
    done = in_container(f"{run}; hsr8 plot /mnt/data/quick/*")
    assert json.loads(done.stdout)["walk_ticks"] == 101
    assert done.returncode == 2
    (line,) = (line for line in done.stderr.splitlines() if line.startswith("hsr8: "))
    assert "expected MPLCONFIGDIR=DIR" in line
    assert "Traceback" not in done.stderr
    assert "compiling" not in done.stderr


def test_a_run_folder_that_cannot_be_made_is_named_with_the_option():
    done = in_container(f"hsr8 run quick {KINEMATIC}")
    assert done.returncode == 3
    (line,) = (line for line in done.stderr.splitlines() if line.startswith("hsr8: "))
    assert "choose another with --out" in line
