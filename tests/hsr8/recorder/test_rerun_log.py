import subprocess
import sys
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
import rerun as rr
from rerun.chunk import RrdReader

from hsr8.recorder.rerun_log import RerunLog
from hsr8.world.truth import PushActing
from walking.admission import AdmissionReport, Limit
from walking.command import VelocityCommand


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
    assert rows["/plots/zmp_left"] == rows["/plots/torque_knee"] == 76 + 1
    assert rows["/world/walking/points"] == 76 + 1
    # The soles that carry are logged once a phase.
    assert 9 <= rows["/world/walking/support"] <= 11


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


def _values(path, entity, component="Scalars:scalars"):
    """Times [s] and values of one component."""
    found = []
    for chunk in RrdReader(str(path)).stream():
        batch = chunk.to_record_batch()
        if str(chunk.entity_path) == entity and component in batch.schema.names:
            if "sim_time" not in batch.schema.names:
                continue
            times = batch.column("sim_time").to_numpy().astype("timedelta64[ns]")
            found += zip(
                times / np.timedelta64(1, "s"), batch.column(component).to_pylist(), strict=True
            )
    return sorted(found)


def test_pushes_and_altered_commands_are_logged_when_they_change(log, fake):
    path, listener = log
    asked, given = VelocityCommand(0.5), VelocityCommand(0.3)
    altered = AdmissionReport(asked, given, (Limit.SPEED, Limit.LANDING_FROZEN))
    routine = AdmissionReport(given, given, (Limit.LANDING_FROZEN,))
    push = PushActing(
        0, 0.2, 0.05, "torso_link", 0.0, np.array([0.0, 0.0, 0.3]), np.array([4.0, 0.0, 0.0])
    )
    for k in range(50):
        record = fake.record(0.02 * k, pushes=(push,) if 10 <= k < 13 else ())
        report = altered if 20 <= k < 30 else routine
        listener.on_record(replace(record, walking=replace(record.walking, admission=report)))
    listener.close("completed")
    rows = _rows(path)
    assert rows["/world/pushes"] == 3 + 1 + 1
    assert rows["/admission"] == 2


def test_the_achieved_velocity_is_logged_once_a_footstep(log, walk):
    path, listener = log
    for record in walk(4.0):
        listener.on_record(record)
    listener.close("goal")
    values = _values(path, "/plots/speed_forward/achieved")
    assert len(values) >= 9
    assert [v[1][0] for v in values] == pytest.approx([0.2] * len(values))
