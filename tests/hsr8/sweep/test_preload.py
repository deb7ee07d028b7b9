import subprocess
import sys

LOADED = """
import os, sys
import hsr8.sweep.preload
from mujoco import egl
from walking.walk import plan_tick
print(len(os.listdir("/proc/self/task")), len(plan_tick.signatures), egl.EGL_DISPLAY)
print("rerun" in sys.modules)
"""


def test_the_server_forks_with_one_thread_and_kernels_and_without_a_display_and_rerun(monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "1")
    command = [sys.executable, "-c", LOADED]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=300)
    assert done.stdout.split() == ["1", "1", "None", "False"]
