import gc
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import rerun as rr
from rerun.chunk import RrdReader

from hsr8.errors import RecordingFailed
from hsr8.robots.loaded import load_robot
from hsr8.scenario.loader import load_scenario
from hsr8.show.log.run_log import MAX_INDEXED, WRITE_TIMEOUT, RunLog
from hsr8.show.log.stream import LogStream
from hsr8.world.truth.truth import ActivePush
from navigation.belief.belief import Particles
from navigation.decision import GazeDecision
from tests.hsr8.show.log.batches import batch_of
from walking.command import CommandLimits, Limit, VelocityCommand


@pytest.fixture(autouse=True)
def strict():
    """Rerun ignores its errors by default."""
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
def folder(tmp_path):
    path = tmp_path / "7-abc"
    path.mkdir()
    return path


def _logged(folder, model, layout, records, **options):
    """Log of `records`."""
    path = folder / "log.rrd"
    log = _opened(path, model, layout, **options)
    log.add(batch_of(records, full=options.get("full", False)))
    log.close("goal")
    return path


def _opened(path, model, layout, duration=10.0, **options):
    scenario = load_scenario("quick", [f"duration={duration}"])
    return RunLog(path, (model, load_robot("hsr8"), layout), scenario, name="7-abc", **options)


@pytest.fixture
def log(tmp_path, model, layout):
    path = tmp_path / "log.rrd"
    return path, _opened(path, model, layout)


def test_a_run_is_logged_at_its_rates(log, walk):
    path, log = log
    log.add(batch_of(walk(3.0), [(1.0, "collision", "l_sole touches obstacle 0")]))
    log.close("goal")
    rows = _rows(path)
    assert rows["/events"] == 2
    # 17 Hz of poses, a third of the camera frames; one row more holds what never changes.
    assert rows["/world/robot/ellipsoids"] == 51 + 1
    assert rows["/plots/tilt"] == 51 + 1
    assert rows["/world/camera/image"] == 17 + 1
    assert rows["/belief/tracks"] == 17 + 1
    assert rows["/belief/local_map"] >= 3
    assert rows["/world/obstacles/cylinders"] == 1
    assert rows["/world/beacons/cylinders"] == 1
    assert rows["/world/movers"] == 51 + 1
    assert rows["/plots/zmp_left"] == rows["/plots/torque_knee"] == 51 + 1
    assert rows["/world/walking/points"] == 51 + 1
    # The soles that carry are logged once a phase.
    assert 9 <= rows["/world/walking/support"] <= 11


def test_a_full_log_leaves_nothing_out(folder, model, layout, walk):
    rows = _rows(_logged(folder, model, layout, walk(1.0), full=True))
    assert rows["/world/robot/ellipsoids"] == 51 + 1
    assert rows["/world/camera/image"] == rows["/belief/tracks"] == 17 + 1
    assert rows["/belief/local_map"] == 1 + 1  # recorded once per second


class Field:
    """Leads ahead everywhere."""

    def at(self, points):
        return np.broadcast_to([2.0, 0.0], np.shape(points))


def test_the_field_is_shown_where_there_is_one(folder, model, layout, fake):
    records = []
    for k, field in enumerate((Field(), None, Field())):
        frame = fake.frame(0.6 * k)
        motion = replace(frame.motion, field=field)
        frame = replace(frame, decision=replace(frame.decision, motion=motion))
        records.append(fake.record(0.6 * k, frame=frame))
    path = _logged(folder, model, layout, records)
    arrows = _values(path, "/plan/field", "Arrows3D:vectors")
    paths = _values(path, "/plan/path", "LineStrips3D:strips")
    assert [time for time, _ in arrows] == [time for time, _ in paths] == [0.0, 1.2]
    assert np.array(arrows[0][1]) == pytest.approx(
        np.tile([0.13, 0.0, 0.0], (len(arrows[0][1]), 1))
    )
    assert len(paths[0][1]) == 1
    assert len(_values(path, "/plan/decision", "Arrows3D:vectors")) == 3


def test_a_gaze_without_a_map_is_shown(folder, model, layout, fake):
    records = []
    for k in range(3):
        frame = fake.frame(0.06 * k)
        decision = replace(frame.decision, gaze=GazeDecision(0.1 * k, -0.4))
        records.append(fake.record(0.06 * k, frame=replace(frame, decision=decision)))
    path = _logged(folder, model, layout, records)
    columns = [np.array(c)[0, 0] for _, c in _values(path, "/gaze/choice", "Points2D:positions")]
    assert len(columns) == 3
    assert np.all(np.diff(columns) < 0.0)
    assert len(_values(path, "/gaze/window", "LineStrips2D:strips")) == 3
    assert not _values(path, "/gaze/map", "EncodedImage:blob")


def test_particles_show_where_a_lost_mover_may_be(folder, model, layout, fake):
    places = np.array([[1.0, 0.5], [1.2, -0.5]])
    cloud = Particles(places, np.zeros((2, 2)), np.zeros(2), np.array([0.1, 0.9]))
    lost = replace(fake.track(2, 0.0), particles=cloud)
    record = fake.record(0.0, frame=fake.frame(0.0, tracks=(fake.track(0, 0.0), lost)))
    path = _logged(folder, model, layout, [record])
    ((_, shown),) = _values(path, "/belief/particles", "Points3D:positions")
    assert np.array(shown)[:, :2] == pytest.approx(places)
    ((_, radii),) = _values(path, "/belief/particles", "Points3D:radii")
    assert radii[0] < radii[1]


def test_a_finished_log_is_verified_by_rerun(folder, model, layout, walk):
    program = Path(sys.executable).with_name("rerun")
    if not program.exists():
        pytest.skip("there is no rerun executable")
    path = _logged(folder, model, layout, walk(0.5))
    done = subprocess.run(
        [program, "rrd", "verify", path], check=False, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr


def test_a_viewer_receives_the_rows_of_the_file(folder, model, layout, walk, monkeypatch):
    """Batch by batch, as the recorder passes them."""
    address = "rerun+http://127.0.0.1:1/proxy"
    monkeypatch.setattr(rr, "GrpcSink", {address: rr.FileSink(str(folder / "live.rrd"))}.get)
    records = [*walk(0.5)]
    path, log = _logged(folder, model, layout, records), _opened(address, model, layout)
    tables = batch_of(records)
    for begin, end in ((0.0, 0.02), (0.04, 0.14), (0.16, 9.0)):
        windows = {name: table.window(begin, end) for name, table in tables.items()}
        log.add({name: table for name, table in windows.items() if len(table)})
    log.close("goal")
    assert _rows(folder / "live.rrd") == _rows(path)


@pytest.mark.filterwarnings("ignore:RRD file has no footer")
def test_without_an_index_the_log_holds_the_same(tmp_path, model, layout, walk):
    logs = []
    for name, duration in (("with", 1.0), ("without", 2.0 * MAX_INDEXED)):
        (tmp_path / name).mkdir()
        logs.append(_logged(tmp_path / name, model, layout, walk(0.5), duration=duration))
    with_index, without = logs
    assert _rows(with_index) == _rows(without)
    assert with_index.stat().st_size > without.stat().st_size


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="threads are counted on Linux")
def test_logs_one_after_the_other_leave_no_threads(folder, model, layout, walk):
    counts = []
    for _ in range(3):
        _logged(folder, model, layout, walk(0.1))
        gc.collect()
        counts.append(len(list(Path("/proc/self/task").iterdir())))
    assert counts[-1] == counts[1]


def test_a_log_that_cannot_be_written_is_abandoned(folder, log, monkeypatch):
    _, log = log
    left = []

    def stalled(stream, *, timeout_sec):
        assert timeout_sec == WRITE_TIMEOUT
        raise RuntimeError("timed out")

    monkeypatch.setattr(LogStream, "flush", stalled)
    monkeypatch.setattr(LogStream, "disconnect", lambda stream: pytest.fail("waits for ever"))
    monkeypatch.setattr("hsr8.show.log.stream.ABANDONED", left)
    monkeypatch.setattr(rr, "unregister_shutdown", lambda: left.append("at the end of the process"))
    with pytest.raises(RecordingFailed, match="timed out"):
        log.require_written(folder)
    assert [type(entry) for entry in left] == [LogStream, str]


def test_an_empty_belief_is_logged(log, fake):
    path, log = log
    frame = fake.frame(0.0, tracks=(), image=None)
    record = fake.record(0.0, frame=frame, zmp=np.full(2, np.nan), clearance=np.inf)
    log.add(batch_of([record]))
    log.close("completed")
    assert _rows(path)["/belief/tracks"] == 2


def _values(path, entity, component="Scalars:scalars"):
    """Times [s] and values of one component."""
    values = []
    for chunk in RrdReader(str(path)).stream():
        batch = chunk.to_record_batch()
        if str(chunk.entity_path) == entity and component in batch.schema.names:
            if "sim_time" not in batch.schema.names:
                continue
            times = batch.column("sim_time").to_numpy().astype("timedelta64[ns]")
            values += zip(
                times / np.timedelta64(1, "s"), batch.column(component).to_pylist(), strict=True
            )
    return sorted(values)


def test_pushes_and_limits_are_logged_when_they_change(log, fake):
    path, log = log
    asked, given = VelocityCommand(0.5), VelocityCommand(0.3)
    altered = CommandLimits(asked, given, (Limit.SPEED, Limit.LANDING_FROZEN))
    routine = CommandLimits(given, given, (Limit.LANDING_FROZEN,))
    push = ActivePush(
        0, 0.2, 0.05, "torso_link", 0.0, np.array([0.0, 0.0, 0.3]), np.array([4.0, 0.0, 0.0])
    )
    records = []
    for k in range(50):
        record = fake.record(0.02 * k, pushes=(push,) if 10 <= k < 13 else ())
        report = altered if 20 <= k < 30 else routine
        records.append(replace(record, walking=replace(record.walking, command_limits=report)))
    for part in (records[:12], records[12:25], records[25:]):  # batches may end anywhere
        log.add(batch_of(part))
    log.close("completed")
    rows = _rows(path)
    assert rows["/world/pushes"] == 3 + 1 + 1
    assert rows["/command_limits"] == 2


def test_the_achieved_velocity_is_logged_once_per_footstep(log, walk):
    path, log = log
    log.add(batch_of(walk(4.0)))
    log.close("goal")
    values = _values(path, "/plots/speed_vx/achieved")
    assert len(values) >= 9
    assert [v[1][0] for v in values] == pytest.approx([0.2] * len(values))
