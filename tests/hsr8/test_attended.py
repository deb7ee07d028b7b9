import subprocess
import sys

from hsr8.attended import attended

PARENT = """
import os, subprocess, sys
child = "import sys, time; import hsr8.attended as a;"
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
    words = [sys.executable, "-c", "import hsr8.attended as a; print(a.ends_with(1))"]
    done = subprocess.run(words, capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.strip() == "False"


def test_a_program_that_is_attended_ends_with_its_parent():
    """Its standard output is the parent's, which is closed when both have ended."""
    script = (
        "import os, subprocess; from hsr8.attended import attended;"
        "child = subprocess.Popen(attended(['/bin/sh', '-c', 'echo here; exec sleep 60']),"
        " stdout=subprocess.PIPE, start_new_session=True);"
        "print(child.stdout.readline(), flush=True); os.kill(os.getpid(), 9)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=40
    )
    assert done.returncode == -9
    assert "here" in done.stdout


def test_a_program_that_is_attended_keeps_its_exit_code():
    words = attended(["/bin/sh", "-c", "exit 7"])
    assert subprocess.run(words, check=False, timeout=60).returncode == 7


def test_modules_of_the_present_folder_are_not_its_own(tmp_path):
    (tmp_path / "signal.py").write_text("raise SystemExit('not this one')")
    words = attended(["/bin/sh", "-c", "exit 7"])
    assert subprocess.run(words, check=False, timeout=60, cwd=tmp_path).returncode == 7
