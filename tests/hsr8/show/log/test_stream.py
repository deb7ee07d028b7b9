import numpy as np
import pytest
import rerun as rr

from hsr8.show.log.blueprint import blueprint
from hsr8.show.log.stream import LogStream
from tests.hsr8.show.log.reading import Log


@pytest.fixture
def logged(tmp_path):
    """Write a log by a function of the stream and read it."""

    def write(log):
        stream = LogStream("test")
        stream.save(tmp_path / "log.rrd")
        log(stream)
        stream.disconnect()
        return Log(tmp_path / "log.rrd")

    return write


def test_rows_have_their_numbers_of_instances(logged):
    counts, positions = [4, 0, 1, 3], np.random.default_rng(0).normal(size=(8, 3))
    times = np.arange(4.0)

    def log(stream):
        stream.rows("/x", rr.Points3D, times, counts, positions=positions)
        stream.rows("/x", rr.Points3D, times[:0], counts[:0], positions=positions[:0])

    table = logged(log).table("/x", "Points3D:positions")
    assert table.time == times.tolist()
    assert [len(row) for row in table.rows] == counts
    assert np.concatenate([row for row in table.rows if row]) == pytest.approx(positions)


@pytest.mark.parametrize("ends", [[6], [1, 2, 6], [3, 3, 4, 6]])
def test_changes_and_throttles_go_on_from_batch_to_batch(logged, ends):
    times, states = 0.1 * np.arange(6), ["a", "a", "b", "b", "b", "a"]

    def log(stream):
        for first, last in zip([0, *ends], ends, strict=False):
            stream.lane("/state", times[first:last], states[first:last])
            rows = stream.due("values", times[first:last], 0.2)
            stream.curves("/plot", times[first:last][rows], np.zeros((len(rows), 2)))

    log = logged(log)
    lane = log.table("/state", "StateChange:state")
    assert lane.time == pytest.approx([0.0, 0.2, 0.5])
    assert lane.rows == [["a"], ["b"], ["a"]]
    assert log.table("/plot", "Scalars:scalars").time == pytest.approx([0.0, 0.2, 0.4])


def test_the_arrangement_is_in_the_file_as_with_set_sinks(tmp_path):
    ours, theirs, shown = LogStream("test"), LogStream("test"), blueprint(5.0, walking=False)
    ours.begin(rr.FileSink(str(tmp_path / "ours.rrd")), shown)
    theirs.set_sinks(rr.FileSink(str(tmp_path / "theirs.rrd")), default_blueprint=shown)
    for stream in (ours, theirs):
        stream.disconnect()
    sizes = [(tmp_path / f"{name}.rrd").stat().st_size for name in ("ours", "theirs")]
    assert sizes[0] == pytest.approx(sizes[1], rel=0.01)
    assert sizes[0] > 100_000
