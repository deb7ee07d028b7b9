import subprocess
import sys

PARENT = """
import os, subprocess, sys
child = "import sys, time; import hsr8.process.signals as a;"
child += "print(a.end_with_parent(PARENT), flush=True); time.sleep(60)"
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


def test_a_watched_program_ends_with_its_parent():
    """Its standard output is the parent's, which is closed when both have ended."""
    script = (
        "import os, subprocess; from hsr8.process.signals import with_parent_watch;"
        "child = subprocess.Popen(with_parent_watch(['/bin/sh', '-c', 'echo here; exec sleep 60']),"
        " stdout=subprocess.PIPE, start_new_session=True);"
        "print(child.stdout.readline(), flush=True); os.kill(os.getpid(), 9)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=40
    )
    assert done.returncode == -9
    assert "here" in done.stdout
