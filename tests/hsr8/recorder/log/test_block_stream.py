import pytest
import rerun as rr

from hsr8.recorder.log.block_stream import BlockStream
from hsr8.recorder.log.blueprint import blueprint
from hsr8.recorder.log.channel import Channel
from tests.hsr8.recorder.log.reading import Log


def test_the_rows_of_a_channel_are_sent_once(tmp_path):
    stream = BlockStream("test")
    stream.save(tmp_path / "log.rrd")
    channel = Channel(stream, "/plots/x", rr.Scalars)
    for block in range(3):
        for k in range(2):
            channel.add(float(2 * block + k), scalars=[float(block)])
        stream.send()
        stream.send()
    stream.disconnect()
    table = Log(tmp_path / "log.rrd").table("/plots/x", "Scalars:scalars")
    assert [value for (value,) in table.rows] == [0.0, 0.0, 1.0, 1.0, 2.0, 2.0]


def test_the_arrangement_is_in_the_file_as_with_set_sinks(tmp_path):
    ours, theirs = BlockStream("test"), BlockStream("test")
    ours.begin(
        [rr.FileSink(str(tmp_path / "ours.rrd"))], blueprint(5.0, walking=False, images=True)
    )
    theirs.set_sinks(
        rr.FileSink(str(tmp_path / "theirs.rrd")),
        default_blueprint=blueprint(5.0, walking=False, images=True),
    )
    for stream in (ours, theirs):
        stream.disconnect()
    sizes = [(tmp_path / f"{name}.rrd").stat().st_size for name in ("ours", "theirs")]
    assert sizes[0] == pytest.approx(sizes[1], rel=0.01)
    assert sizes[0] > 100_000
