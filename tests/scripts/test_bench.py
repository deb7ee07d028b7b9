import gc

import bench
from bench_pairs import comparison, turn_of
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


def test_two_checkouts_are_compared_by_medians():
    def turn(floors, more=""):
        rows = [
            "| stage | calls | mean [ms] | p99 [ms] | per simulated second [ms] | over the floor |",
            "|---|---|---|---|---|---|",
            f"| gaze | 16 | 1.000 | 2.000 | 20.0 | {floors:.3f} |",
            "| floor: physics | 200 | 0.200 | 0.300 | 40.0 | 0.800 |",
            more,
            f"| whole loop | | | | 200.0 | {4.0 * floors:.3f} |",
        ]
        return turn_of("\n".join(["`course`, seed 5: ...", "", *rows]))

    more = "| garbage collections | | | | 1.0 | 0.020 |"
    lines = comparison([(turn(a, more), turn(0.5)) for a in (0.2, 9.0, 0.25)])
    assert "| gaze | 0.250 | 0.500 | 0.50 |" in lines
    assert "| garbage collections | 0.020 | | |" in lines
    assert "| whole loop | 1.000 | 2.000 | 0.50 |" in lines
    assert lines[-1].endswith("physics alone took 40 and 40 ms.")
