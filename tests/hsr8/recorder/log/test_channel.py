import numpy as np
import pytest
import rerun as rr

from hsr8.recorder.log.blueprint import blueprint
from hsr8.recorder.log.channel import BlockStream, Channel
from tests.hsr8.recorder.log.reading import Log

RNG = np.random.default_rng(0)


def points(n):
    return {
        "positions": RNG.normal(size=(n, 3)),
        "colors": RNG.integers(0, 2**32, n, dtype=np.uint32),
        "labels": [f"{value:.2f}" for value in RNG.normal(size=n)],
    }


class Stream:
    """Recording that sends nothing."""

    def __init__(self):
        self.channels = []


def sent(channel, monkeypatch):
    """Times and components of the rows that a channel sends."""
    calls = []

    def send(path, indexes, columns, recording):
        assert path == "/there"
        (times,) = indexes
        calls.append((times, {str(c.component_descriptor()): c for c in columns}))

    monkeypatch.setattr(rr, "send_columns", send)
    channel.send(None)
    if not calls:
        return None
    ((times, columns),) = calls
    rows = {name: column.as_arrow_array().to_pylist() for name, column in columns.items()}
    return times.as_arrow_array().to_pylist(), rows


def test_rows_added_together_equal_rows_added_singly(monkeypatch):
    counts = [4, 0, 1, 3]
    together, singly = (Channel(Stream(), "/there", rr.Points3D) for _ in range(2))
    for _ in range(2):
        rows = [points(n) for n in counts]
        together.add_rows(
            [0.1 * k for k in range(len(rows))],
            counts,
            positions=np.concatenate([row["positions"] for row in rows]),
            colors=np.concatenate([row["colors"] for row in rows]),
            labels=[label for row in rows for label in row["labels"]],
        )
        for k, row in enumerate(rows):
            singly.add(0.1 * k, **row)
        times, values = sent(together, monkeypatch)
        assert len(times) == len(counts)
        assert (times, values) == sent(singly, monkeypatch)
        for component in values.values():
            assert [len(row) for row in component] == counts


def test_what_is_sent_is_removed(monkeypatch):
    channel = Channel(Stream(), "/there", rr.Points3D)
    assert sent(channel, monkeypatch) is None
    channel.add(0.0, **points(2))
    assert sent(channel, monkeypatch) is not None
    assert sent(channel, monkeypatch) is None


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
