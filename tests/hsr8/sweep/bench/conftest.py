"""Entries of a benchmark, made up."""

from dataclasses import replace

import pytest

from hsr8.sweep.bench.entry import Entry, row

RUN = {
    "outcome": "passed",
    "success": True,
    "exit_reason": "goal",
    "collisions": 0,
    "falls": 0,
    "time_to_goal_s": 80.0,
    "certified_time_s": 60.0,
    "path_length_m": 12.5,
    "certified_length_m": 10.0,
    "min_clearance_m": 0.2,
    "head_travel_radps": 0.5,
    "state_hash": "abc",
}
FAILED = {"outcome": "failed", "success": False, "time_to_goal_s": None}
CHANGES = {
    "success": {},
    "timeout": FAILED | {"exit_reason": "timeout"},
    "collision": FAILED | {"collisions": 2},
    "fall": FAILED | {"falls": 1, "exit_reason": "fall"},
}


def run(seed, outcome="success", **more):
    """Return the result of a run by its outcome."""
    if outcome in ("crashed", "refused"):
        return row({"seed": seed, "outcome": outcome})
    return row({"seed": seed, **RUN, **CHANGES[outcome], **more})


@pytest.fixture(scope="session")
def make_run():
    return run


@pytest.fixture(scope="session")
def make_entry():
    """Entry with the outcomes of the seeds 1000, ... of two families."""

    def entry(name="default", course=("success",) * 4, crowd=("success",) * 4, **changes):
        made = Entry(
            name=name,
            suite="hsr8",
            suite_version=1,
            suite_hash="123abc",
            seeds="quick",
            command=f"hsr8 bench --quick --name {name}",
            settings={},
            versions={"hsr8": "0.1.0", "code": "1", "mujoco": "4.0.0"},
            scenarios={"course": "a", "crowd": "b"},
            runs={
                family: [run(1000 + k, outcome) for k, outcome in enumerate(outcomes)]
                for family, outcomes in (("course", course), ("crowd", crowd))
            },
        )
        return replace(made, **changes)

    return entry
