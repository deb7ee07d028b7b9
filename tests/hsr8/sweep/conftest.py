import pytest

from hsr8.sweep.definition import Definition


@pytest.fixture
def definition():
    return Definition(
        name="course",
        command_words=("hsr8", "run", "course", "--set", "a=[1, 2]"),
        hsr8="1",
        code="abc",
        processor="x86_64",
        libraries={"mujoco": "4"},
        scenario='name = "course"\nseed = 1\nduration = 3.0\n[world]\nsize = [4.0, 4.0]\n',
    )


@pytest.fixture
def result():
    """Makes the result of a successful run, with changes."""

    def make(seed, **change):
        return {
            "seed": seed,
            "outcome": "passed",
            "attempts": 1,
            "success": True,
            "collisions": 0,
            "collisions_moving": 0,
            "falls": 0,
            "path_length_m": 10.0,
            "min_clearance_m": 0.1,
            "arrival_error_deg": 2.0,
            "time_to_goal_s": 50.0,
            "exit_reason": "goal",
            **change,
        }

    return make
