import gc

import bench
from stopwatch import Stopwatch


def test_only_what_is_much_slower_is_told():
    kept = {"physics": 1.0, "vision": 0.5, "mission": 0.01, "whole loop": 3.0}
    found = {"physics": 1.19, "vision": 0.61, "mission": 0.03, "whole loop": 3.7, "new": 9.0}
    told = bench.slower(found, kept)
    assert [line.partition(":")[0] for line in told] == ["vision", "whole loop"]
    assert "22% above 0.50" in told[0]


class Work:
    """Two stages, one inside the other, that collect garbage now and then."""

    def __init__(self):
        self.calls = 0

    def outer(self):
        self.inner()

    def inner(self):
        self.calls += 1
        if self.calls % 2 == 0:
            gc.collect()


def test_collections_and_first_calls_are_not_part_of_a_stage():
    work, kept = Work(), [[i] for i in range(200_000)]  # a collection takes milliseconds
    with Stopwatch() as watch:
        watch.watch(Work, "outer", "outer")
        watch.watch(Work, "inner", "inner")
        for _ in range(5):
            work.outer()
    assert len(kept) > len(watch.collections) >= 2
    assert {stage: len(times) for stage, times in watch.times.items()} == {"outer": 4, "inner": 4}
    assert watch.first.keys() == {"outer", "inner"}
    assert watch.total("outer", "inner") < 0.2 * sum(watch.collections)
    assert watch._collect not in gc.callbacks
