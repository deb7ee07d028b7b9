import subprocess
import sys

PARENT = """
import os, subprocess, sys
child = "import sys, time; import hsr8.cli.attended as a;"
child += "a.entry = lambda _: (print('on', flush=True), time.sleep(60)); a.main([PARENT])"
child = child.replace("PARENT", repr(str(os.getpid())))
process = subprocess.Popen([sys.executable, "-c", child], stdout=subprocess.PIPE, text=True)
print(process.stdout.readline(), flush=True)
os.kill(os.getpid(), 9)
"""


def test_it_ends_with_a_parent_that_is_killed():
    """It shares its standard error with the parent, which is closed when both have ended."""
    done = subprocess.run(
        [sys.executable, "-c", PARENT], capture_output=True, text=True, check=False, timeout=40
    )
    assert done.returncode == -9
    assert done.stdout.strip() == "on"


def test_it_does_not_begin_without_its_parent():
    done = subprocess.run(
        [sys.executable, "-m", "hsr8.cli.attended", "1", "list"],
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.returncode == 130
    assert done.stdout == ""
