import subprocess
import sys

PARENT = """
import os, subprocess, sys
child = "import sys, time; import hsr8.cli.attended as a;"
child += "print(a.ends_with(PARENT), flush=True); time.sleep(60)"
child = child.replace("PARENT", str(os.getpid()))
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
    assert done.stdout.strip() == "True"


def test_it_is_told_where_its_parent_is_gone():
    words = [sys.executable, "-c", "import hsr8.cli.attended as a; print(a.ends_with(1))"]
    done = subprocess.run(words, capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.strip() == "False"
