"""Everything a run needs, loaded by importing this module in the fork server of a sweep.

The server forks with one thread, without an OpenGL context and without Rerun, which starts
threads on import.
"""

import gc
import os
import signal
from contextlib import suppress

from hsr8.process.signals import end_with_parent

end_with_parent(os.getppid(), signal.SIGKILL)
os.environ["JE_ARROW_MALLOC_CONF"] = "background_thread:false"  # a thread of PyArrow

import hsr8.sweep.job  # noqa: E402, F401
from hsr8.scenario.loader import load_scenario  # noqa: E402
from hsr8.simulation.loop import Simulation  # noqa: E402

# A short run loads the compiled kernels. If it fails, the runs of the sweep report the reason.
with suppress(Exception):
    SHORT = ("robot.body=kinematic", "camera.source=analytic", "duration=1.0")
    Simulation(load_scenario("quick", SHORT, 0), 0).run()
gc.collect()
gc.freeze()  # garbage collection leaves the memory that all runs share alone
