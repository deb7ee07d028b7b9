import subprocess
import sys
from collections import Counter

import numpy as np
import pytest
import rerun as rr
from rerun.chunk import RrdReader

from hsr8.recorder.rerun_log import RerunLog


@pytest.fixture(autouse=True)
def strict():
    """Rerun swallows its errors unless told otherwise."""
    rr.set_strict_mode(True)
    yield
    rr.set_strict_mode(False)


def _rows(path):
    """Number of rows of every entity, static ones included."""
    rows = Counter()
    for chunk in RrdReader(str(path)).stream():
        rows[str(chunk.entity_path)] += chunk.to_record_batch().num_rows
    return rows


@pytest.fixture
def log(tmp_path, model, layout):
    (tmp_path / "7-abc").mkdir()
    path = tmp_path / "7-abc" / "log.rrd"
    return path, RerunLog(path, model, layout, (320, 240), "test 7")


def test_a_run_is_logged_at_its_rates(log, walk):
    path, listener = log
    for record in walk(3.0):
        listener.on_record(record)
    listener.on_event(1.0, "collision", "l_sole touches obstacle 0")
    listener.close("goal")
    rows = _rows(path)
    assert rows["/events"] == 2
    # 25 Hz of poses, 8.3 Hz of camera frames; one row more holds what never changes.
    assert rows["/world/robot/ellipsoids"] == 76 + 1
    assert rows["/plots/tilt"] == 76 + 1
    assert rows["/world/camera/image"] == 26 + 1
    assert rows["/belief/tracks"] == 26 + 1
    assert rows["/belief/local_map"] >= 5
    assert rows["/world/obstacles/cylinders"] == 1
    assert rows["/world/beacons/cylinders"] == 1
    assert rows["/world/movers"] == 76 + 1


def test_nothing_believed_nothing_seen_is_logged_too(log, fake):
    path, listener = log
    frame = fake.frame(0.0, tracks=(), image=None)
    listener.on_record(fake.record(0.0, frame=frame, zmp=np.full(2, np.nan), clearance=np.inf))
    listener.close("completed")
    assert _rows(path)["/belief/tracks"] == 2


@pytest.mark.filterwarnings("ignore:RRD file has no footer")  # a kill leaves none
def test_a_killed_run_leaves_a_log_that_opens(tmp_path):
    """The process is ended by the system, without a chance to finish the file."""
    script = """
import os, sys, rerun as rr
from hsr8.recorder.channel import Channel
stream = rr.RecordingStream("hsr8", recording_id="killed")
stream.save(sys.argv[1])
channel = Channel(stream, "/plots/x", rr.Scalars.columns)
for k in range(100):
    channel.add(0.02 * k, scalars=[float(k)])
    if k % 50 == 49:
        channel.flush()
stream.flush()
os.kill(os.getpid(), 9)
"""
    file = tmp_path / "log.rrd"
    done = subprocess.run([sys.executable, "-c", script, str(file)], check=False, timeout=60)
    assert done.returncode == -9
    assert _rows(file)["/plots/x"] == 100
