import rerun as rr
import rerun_bindings

from hsr8.recorder.block_stream import BlockStream
from hsr8.recorder.channel import Channel
from hsr8.recorder.log_reader import Log


def test_columns_are_sent_when_asked_for_and_once(tmp_path, monkeypatch):
    sent = []
    really = rerun_bindings.send_arrow_chunk

    def send(path, *rest):
        sent.append(path)
        really(path, *rest)

    monkeypatch.setattr(rerun_bindings, "send_arrow_chunk", send)
    stream = BlockStream("test")
    stream.save(tmp_path / "log.rrd")
    channel = Channel(stream, "/plots/x", rr.Scalars.columns)
    for block in range(3):
        for k in range(2):
            channel.add(float(2 * block + k), scalars=[float(block)])
        channel.flush()
    assert sent == []
    stream.send()
    stream.send()
    assert sent == ["/plots/x"] * 3
    stream.disconnect()
    table = Log([tmp_path / "log.rrd"]).table("/plots/x")
    assert table.array()[:, 0].tolist() == [0.0, 0.0, 1.0, 1.0, 2.0, 2.0]
