import numpy as np
import rerun as rr

from hsr8.recorder.log.channel import Channel

RNG = np.random.default_rng(0)


def points(n):
    return {
        "positions": RNG.normal(size=(n, 3)),
        "colors": RNG.integers(0, 2**32, n, dtype=np.uint32),
        "labels": [f"{value:.2f}" for value in RNG.normal(size=n)],
    }


class Stream:
    """Recording that sends nothing."""

    def add_channel(self, channel):
        pass


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
