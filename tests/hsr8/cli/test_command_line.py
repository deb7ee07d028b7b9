from pathlib import Path

import pytest

from hsr8.cli.command_line import command_words, option_tables, run_options, settings
from hsr8.cli.main import parse
from hsr8.cli.options import Check, Run, Sweep

RUN = Run("my room.toml", duration=2.5, set=(("a=1", "b=2"), ("c=x y",)), body="kinematic")


def test_settings_are_those_of_every_set():
    assert settings(RUN) == ("a=1", "b=2", "c=x y")


@pytest.mark.parametrize(
    "options",
    [
        RUN,
        Run(
            "quick",
            robot="my robot.toml",
            seed=-3,
            out=Path("a b"),
            log=True,
            view="web",
        ),
        Sweep("quick", seeds="0:3", vary=(("a=1,2", "b=3"),), keep="none", timeout=1e3),
    ],
)
def test_the_words_give_the_same_options(options):
    assert parse(command_words(options)[1:]) == options


def test_output_options_are_left_out():
    assert command_words(Run("quick", json=True, quiet=True)) == ("hsr8", "run", "quick")


def test_a_check_and_a_sweep_lead_to_runs_of_the_same_scenario():
    check = Check("./room.toml", robot="op3", set=(("world.n_moving=2",),))
    run = Run("./room.toml", seed=0, robot="op3", set=(("world.n_moving=2",),))
    assert run_options(check, 0) == run
    assert option_tables(check) == {"--robot": {"robot": {"model": "op3"}}}
    sweep = Sweep("quick", seeds="0:3", duration=2.0, camera="analytic")
    run = Run("quick", duration=2.0, camera="analytic", set=(("a=1",),))
    assert run_options(sweep, None, ["a=1"]) == run


def test_options_become_tables_of_the_scenario():
    assert option_tables(RUN) == {
        "--duration": {"duration": 2.5},
        "--body": {"robot": {"body": "kinematic"}},
    }
