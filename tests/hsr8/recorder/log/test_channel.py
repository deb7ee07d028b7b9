from types import SimpleNamespace

import numpy as np
import pytest
import rerun as rr

from hsr8.recorder.log.channel import TIMELINE, Channel

RNG = np.random.default_rng(0)


def points(n):
    return {
        "positions": RNG.normal(size=(n, 3)),
        "colors": RNG.integers(0, 2**32, n, dtype=np.uint32),
        "labels": [f"{value:.2f}" for value in RNG.normal(size=n)],
    }


def strips(n):
    return {"strips": [RNG.normal(size=(k + 2, 3)) for k in range(n)]}


def blob(n):
    return {"blob": [RNG.integers(0, 256, 50 + n, dtype=np.uint8)]}


def transform(_):
    return {"translation": RNG.normal(size=(1, 3)), "quaternion": RNG.normal(size=(1, 4))}


KINDS = (
    (rr.Points3D.columns, points),
    (rr.LineStrips3D.columns, strips),
    (rr.EncodedImage.columns, blob),
    (rr.Transform3D.columns, transform),
    (rr.StateChange.columns, lambda n: {"state": [f"state {n}"]}),
)


class Stream:
    """Keeps what is sent."""

    def __init__(self):
        self.sent = []

    def keep(self, path, times, values):
        rows = {str(component): value for component, value in values.items()}
        self.sent.append((path, times[TIMELINE], rows))


@pytest.mark.parametrize(("columns", "rows"), KINDS)
def test_later_blocks_are_what_rerun_itself_makes_of_them(columns, rows):
    stream = Stream()
    taught = Channel(stream, "/there", columns)
    taught.add(0.0, **rows(3))
    taught.flush()
    block = [(0.1 * k, rows(n)) for k, n in enumerate((2, 0, 4, 1))]
    for channel in (taught, Channel(stream, "/there", columns)):
        for time, row in block:
            channel.add(time, **row)
        channel.flush()
    (_, times, later), (_, same_times, first) = stream.sent[1:]
    assert times.equals(same_times)
    assert later.keys() == first.keys()
    for name, values in later.items():
        assert values.type.value_type == first[name].type.value_type
        assert values.to_pylist() == first[name].to_pylist()


def test_rows_at_once_are_rows_one_by_one():
    stream, counts = Stream(), [4, 0, 1, 3]
    once, each = (Channel(stream, "/there", rr.Points3D.columns) for _ in range(2))
    for _ in range(2):
        rows = [points(n) for n in counts]
        once.add_rows(
            [0.1 * k for k in range(len(rows))],
            counts,
            positions=np.concatenate([row["positions"] for row in rows]),
            colors=np.concatenate([row["colors"] for row in rows]),
            labels=[label for row in rows for label in row["labels"]],
        )
        for k, row in enumerate(rows):
            each.add(0.1 * k, **row)
        once.flush()
        each.flush()
    for (_, times, rows), (_, same_times, same) in zip(
        stream.sent[::2], stream.sent[1::2], strict=True
    ):
        assert times.equals(same_times)
        assert [v.to_pylist() for v in rows.values()] == [v.to_pylist() for v in same.values()]


def test_without_rows_nothing_is_sent():
    stream = SimpleNamespace(keep=None)
    Channel(stream, "/there", rr.Points3D.columns).flush()
