"""What it does for the sweep is tested there: tests/hsr8/evaluation/sweep/test_fork_server.py."""

import subprocess
import sys

from hsr8.evaluation.sweep.process import environment

LOADED = """
import os, sys
from hsr8.cli.fork_server import load_everything
load_everything()
from mujoco import egl
from walking.body.leg_kernel import pose
print(len(os.listdir("/proc/self/task")), len(pose.signatures), egl.EGL_DISPLAY)
print("rerun" in sys.modules)
"""


def test_it_forks_with_one_thread_and_its_kernels_and_without_a_display_and_rerun():
    done = subprocess.run(
        [sys.executable, "-c", LOADED],
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
        env=environment(),
    )
    assert done.stdout.split() == ["1", "1", "None", "False"]
