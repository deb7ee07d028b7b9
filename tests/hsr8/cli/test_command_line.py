import shlex

from hsr8.cli.command_line import run_command, settings
from hsr8.cli.options import Check, Run

RUN = Run("my room.toml", duration=2.5, set=(("a=1", "b=2"), ("c=x y",)), body="kinematic")


def test_settings_are_those_of_every_set():
    assert settings(RUN) == ("a=1", "b=2", "c=x y")


def test_the_command_can_be_typed_into_a_shell():
    command = " ".join(run_command(RUN, 3))
    assert command == (
        "hsr8 run 'my room.toml' --seed 3 --duration 2.5 --body kinematic "
        "--set a=1 b=2 --set 'c=x y'"
    )
    assert shlex.split(command)[2] == "my room.toml"


def test_a_check_leads_to_the_run_of_the_same_scenario():
    check = Check("./room.toml", set=(("world.n_moving=2",),))
    assert " ".join(run_command(check, 0)) == (
        "hsr8 run ./room.toml --seed 0 --set world.n_moving=2"
    )
