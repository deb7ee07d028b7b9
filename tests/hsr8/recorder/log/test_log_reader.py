import cv2
import numpy as np
import pytest
import rerun as rr

from hsr8.errors import UsageError
from hsr8.recorder.log.log_reader import Log, read_log
from hsr8.recorder.log.rerun_log import RerunLog
from hsr8.recorder.run.manifest import Manifest
from hsr8.robots.loaded import load_robot
from hsr8.scenario.loader import load_scenario
from tests.hsr8.recorder.log.batches import batch_of


def _write(path, model, layout, records):
    path.parent.mkdir(exist_ok=True)
    log = RerunLog(path, (model, load_robot("hsr8"), layout), load_scenario("quick"))
    log.add(batch_of(records))
    log.close("goal")
    return path


@pytest.fixture(scope="module")
def records(walk):
    return list(walk(2.0))


@pytest.fixture(scope="module")
def file(tmp_path_factory, model, layout, records):
    return _write(tmp_path_factory.mktemp("log") / "log.rrd", model, layout, records)


def test_logged_rows_are_read_back(file, records):
    log = Log(file)
    frames = [r for r in records if r.frame is not None][::3]
    poses = log.table("/belief/pose", "Arrows3D:origins")
    assert poses.time == pytest.approx([r.time for r in frames], abs=1e-9)
    believed = [r.frame.belief.pose[:2] for r in frames]
    assert poses.array()[:, 0, :2] == pytest.approx(np.array(believed), abs=1e-6)
    assert (np.diff(poses.time) > 0.0).all()


def test_curves_have_names(file):
    table = Log(file).table("/plots/partial")
    assert table["ψ obstacle"] == pytest.approx([0.6] * len(table))
    with pytest.raises(KeyError, match="ψ way"):
        table["ψ"]


def test_text_lines_and_images_are_read_too(file):
    log = Log(file)
    assert log.table("/events", "TextLog:text").rows[-1].tolist() == ["end: goal"]
    assert {s for row in log.table("/state/gait").rows for s in row} == {"left", "right"}
    (outline, *_) = log.table("/world/footsteps", "LineStrips3D:strips").rows[0]
    assert outline.shape == (5, 3)
    jpeg = log.table("/world/camera/image").rows[0][0]
    image = cv2.imdecode(jpeg, cv2.IMREAD_COLOR)  # wants bytes, not integers
    assert image.ndim == 3
    assert {a.dtype.kind for a in log.table("/belief/local_map", "GridMap:data").rows[0]} == {"u"}


def test_static_objects_are_logged_once(file, layout):
    table = Log(file).table("/world/obstacles/cylinders", "Cylinders3D:centers")
    assert table.time.tolist() == [-np.inf]
    assert table.rows[0][:, :2] == pytest.approx(np.array([o.position for o in layout.static]))


def test_rows_of_different_lengths_make_no_array(tmp_path, model, layout, fake):
    frames = [fake.frame(0.0), fake.frame(0.2, tracks=())]
    records = [fake.record(f.time, frame=f) for f in frames]
    table = Log(_write(tmp_path / "a" / "log.rrd", model, layout, records)).table(
        "/belief/tracks", "Cylinders3D:radii"
    )
    assert [len(row) for row in table.rows] == [3, 0]
    with pytest.raises(ValueError, match="rows"):
        table.array()


def test_a_cut_log_is_refused_with_the_remedy(file, tmp_path):
    cut = tmp_path / "log.rrd"
    cut.write_bytes(file.read_bytes()[:-3000])
    with pytest.raises(UsageError, match="rerun rrd optimize --continue-on-error"):
        Log(cut).table("/plots/tilt")


def test_an_unknown_name_is_answered_with_known_ones(file):
    log = Log(file)
    for entity, component, message in (
        ("/plots/partail", "", "/plots/partial"),
        ("/belief/pose", "", "Arrows3D:origins, Arrows3D:vectors"),
        ("/belief/pose", "Points3D:positions", "Arrows3D:origins"),
    ):
        with pytest.raises(UsageError, match=message):
            log.table(entity, component)
    assert "Scalars:scalars" in log.entities()["/plots/partial"]


def test_a_missing_run_and_a_missing_log_are_usage_errors(tmp_path):
    with pytest.raises(UsageError, match="no such run folder"):
        read_log(tmp_path / "nothing")
    Manifest.now("quick", 1, (), "analytic").write(tmp_path / "manifest.json")
    with pytest.raises(UsageError, match="--no-log"):
        read_log(tmp_path)


def test_another_file_is_not_a_log(tmp_path):
    other = tmp_path / "log.rrd"
    other.write_text("something else")
    with pytest.raises(UsageError, match=r"log\.rrd"):
        Log(other).entities()


def test_rows_without_instances_are_empty(tmp_path):
    stream = rr.RecordingStream("hsr8")
    stream.save(tmp_path / "log.rrd")
    columns = rr.Points3D.columns(positions=np.ones((2, 3))).partition([0, 2, 0])
    times = [rr.TimeColumn("sim_time", duration=np.arange(3.0))]
    stream.send_columns("/points", times, columns)
    stream.disconnect()
    table = Log(tmp_path / "log.rrd").table("/points")
    assert [len(row) for row in table.rows] == [0, 2, 0]


@pytest.mark.parametrize("length", [0, 12, 20, 40, 100])
def test_a_log_cut_in_its_header_is_refused(tmp_path, length):
    file = tmp_path / "log.rrd"
    stream = rr.RecordingStream("hsr8", recording_id="x")
    stream.save(file)
    stream.disconnect()
    file.write_bytes(file.read_bytes()[:length])
    with pytest.raises(UsageError, match=r"cannot read the log .*log\.rrd"):
        Log(file).entities()
