"""A wrong command line is answered in a sentence, and no right one is refused."""

import contextlib
import io
import random
import shlex

import pytest

from hsr8.cli.main import COMMANDS, entry, parse
from hsr8.cli.signature import signature
from hsr8.cli.wrong_line import mistakes

KINDS = {name: kind for name, (kind, _) in COMMANDS.items()}
VALUES = {"whole number": ["7", "-3", "7.5", "7s"], "number": ["0.5", "-1", "1e3", "5s", "many"]}


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("run quick --seed abc", "--seed abc: give a whole number, without a unit: seed of"),
        ("run quick --seed", "--seed is without a value"),
        ("run quick --duration 5s", "--duration 5s: give a number, without a unit: simulated"),
        ("run quick --body kinemtic", "choose full or kinematic; did you mean 'kinematic'?"),
        ("run quick --view webb", "--view webb: choose native or web; did you mean 'web'?"),
        ("run quick --json=yes", "--json takes no value"),
        ("run quick --set", "--set is without a value"),
        ("run --seed 3", "run needs SCENARIO"),
        ("render a b", "render takes RUN, there is no place for 'b'"),
        ("render a --fps ten", "--fps ten: give a whole number, without a unit: Frames per"),
        ("check relpay runs/quick", "did you mean 'hsr8 check replay'?"),
        ("check replay", "check replay needs RUN"),
        ("doctor please", "doctor takes options only"),
        ("completion bsh", "did you mean 'bash'?"),
        ("--json list", "a command comes first"),
    ],
)
def test_the_sentence_says_what_is_wrong_and_what_is_right(line, said, capsys):
    assert entry(shlex.split(line)) == 2
    printed = capsys.readouterr()
    assert said in printed.err
    assert printed.out == ""
    assert len(printed.err.splitlines()) <= 3


def test_every_mistake_is_told(capsys):
    entry(["run", "--sed", "3", "--body", "stiff", "--duration", "x"])
    said = capsys.readouterr().err
    for word in ("--sed", "--body stiff", "--duration x", "SCENARIO"):
        assert word in said


def test_help_is_given_whatever_else_is_wrong(capsys):
    assert entry(["run", "--sed", "3", "--help"]) == 0
    assert "--seed" in capsys.readouterr().out


def accepted(words):
    with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
        try:
            parse(words)
        except SystemExit:
            return False
    return True


def drawn(name, chance):
    """A command line that may be wrong."""
    words = [name]
    for argument in signature(KINDS[name]):
        share = 0.9 if argument.required else 0.3
        if chance.random() > share or argument.word == "--view":
            continue
        if argument.is_option:
            word = argument.word
            words.append(word if chance.random() > 0.1 else word.replace("-", "_")[:6])
        if argument.kind != "switch" and chance.random() > 0.05:
            values = VALUES.get(argument.kind, ["a", "b=1"])
            words.append(
                chance.choice([*argument.choices, *(values if chance.random() < 0.5 else ["7"])])
            )
    return words if chance.random() > 0.1 else [*words, "more"]


@pytest.mark.parametrize("name", COMMANDS)
def test_what_is_refused_is_what_the_parser_refuses(name):
    chance = random.Random(name)
    for _ in range(4):
        words = drawn(name, chance)
        assert bool(mistakes(words, KINDS)) == (not accepted(words)), shlex.join(words)


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_every_argument_has_its_help(kind):
    for argument in signature(kind):
        assert argument.help, argument.word
        assert argument.kind == "choice" or not argument.choices
