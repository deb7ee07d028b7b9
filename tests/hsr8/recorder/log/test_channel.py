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
    (rr.Points3D, points),
    (rr.LineStrips3D, strips),
    (rr.EncodedImage, blob),
    (rr.Transform3D, transform),
    (rr.StateChange, lambda n: {"state": [f"state {n}"]}),
)


class Stream:
    """Recording that sends nothing."""

    def add_channel(self, channel):
        pass


def taken(channel):
    """Times and rows of a channel, by the names of the components."""
    times, rows = channel.take()
    return times[TIMELINE], {str(component): values for component, values in rows.items()}


@pytest.mark.parametrize(("archetype", "rows"), KINDS)
def test_later_batches_equal_those_of_rerun(archetype, rows):
    taught, fresh = (Channel(Stream(), "/there", archetype) for _ in range(2))
    taught.add(0.0, **rows(3))
    taught.take()
    batch = [(0.1 * k, rows(n)) for k, n in enumerate((2, 0, 4, 1))]
    for channel in (taught, fresh):
        for time, row in batch:
            channel.add(time, **row)
    (times, later), (same_times, first) = taken(taught), taken(fresh)
    assert times.equals(same_times)
    assert later.keys() == first.keys()
    for name, values in later.items():
        assert values.type.value_type == first[name].type.value_type
        assert values.to_pylist() == first[name].to_pylist()


def test_rows_added_together_equal_rows_added_singly():
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
        (times, values), (same_times, same) = taken(together), taken(singly)
        assert times.equals(same_times)
        assert [v.to_pylist() for v in values.values()] == [v.to_pylist() for v in same.values()]


def test_without_rows_there_is_nothing_to_take():
    assert Channel(Stream(), "/there", rr.Points3D).take() is None
