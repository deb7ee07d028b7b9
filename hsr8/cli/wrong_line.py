"""What is wrong with a command line, in a sentence each."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from itertools import pairwise

from hsr8.cli.signature import Argument, signature
from hsr8.suggestion import suggestion

OPTIONAL_VALUE = "--view"  # the only option whose value may be left out
_NEGATIVE = re.compile(r"-(\.?\d|inf|nan)")  # what a negative number begins with
NUMBERS = {"whole number": int, "number": float}


@dataclass(slots=True)
class _Reading:
    """A command line taken apart."""

    operands: list[str] = field(default_factory=list)
    given: set[str] = field(default_factory=set)
    mistakes: list[str] = field(default_factory=list)


def mistakes(words: Sequence[str], commands: dict[str, type]) -> list[str]:
    """Everything that is wrong, a sentence each.

    Args:
        words: of the command line; the first is one of `commands`.
        commands: class of options of each.
    """
    name = words[0]
    arguments = signature(commands[name])
    options = {argument.word: argument for argument in arguments if argument.is_option}
    reading = _read(name, words[1:], options)
    operands = [argument for argument in arguments if not argument.is_option]
    said = reading.mistakes
    said += _missing(name, reading, arguments, operands)
    if not any(argument.many for argument in operands):
        for word in reading.operands[len(operands) :]:
            if word == _after(OPTIONAL_VALUE, words):
                said += _wrong(options[OPTIONAL_VALUE], word)
                continue
            hint = _other_command(name, reading.operands, commands) or _as_value(word, options)
            takes = " ".join(argument.word for argument in operands) or "options only"
            said.append(f"{name} takes {takes}, there is no place for {word!r}{hint}")
    for argument, word in zip(operands, reading.operands, strict=False):
        said += _wrong(argument, word)
    return said


def _read(name: str, words: Sequence[str], options: dict[str, Argument]) -> _Reading:
    reading, rest = _Reading(), list(words)
    while rest:
        word, equals, value = rest.pop(0).partition("=")
        if not is_option(word):
            reading.operands.append(word + equals + value)
            continue
        option = options.get(word.replace("_", "-"))
        if option is None:
            hint = suggestion(word, list(options))
            reading.mistakes.append(
                f"{name} has no option {word!r}{hint} (it has: {', '.join(options)})"
            )
            if not equals and rest and not is_option(rest[0]):
                rest.pop(0)
            continue
        reading.given.add(option.word)
        reading.mistakes += _values(option, [value] if equals else _taken(option, rest))
    return reading


def _taken(option: Argument, rest: list[str]) -> list[str]:
    """The values that belong to `option`, taken from what follows it."""
    if option.kind == "switch":
        return []
    if option.word == OPTIONAL_VALUE:
        return [rest.pop(0)] if rest and rest[0] in option.choices else [option.choices[0]]
    values: list[str] = []
    while rest and not is_option(rest[0]) and (option.many or not values):
        values.append(rest.pop(0))
    return values


def _values(option: Argument, values: Sequence[str]) -> list[str]:
    if option.kind == "switch":
        return [f"{option.word} takes no value, got {value!r}" for value in values]
    if not values:
        return [f"{option.word} is without a value: {_expected(option)}"]
    return [said for value in values for said in _wrong(option, value)]


def _wrong(argument: Argument, value: str) -> list[str]:
    """What is wrong with a value, if something is."""
    if argument.choices and value not in argument.choices:
        hint = suggestion(value, argument.choices)
    elif argument.kind in NUMBERS:
        try:
            NUMBERS[argument.kind](value)
        except ValueError:
            hint = ""
        else:
            return []
    else:
        return []
    head = f"{argument.word} {value}" if argument.is_option else f"{argument.word} {value!r}"
    return [f"{head}: {_expected(argument)}{hint}"]


def _expected(argument: Argument) -> str:
    """What to give."""
    if argument.choices:
        *others, last = argument.choices
        return f"choose {', '.join(others)} or {last}"
    about = f": {argument.help}" if argument.help else ""
    if argument.kind in NUMBERS:
        return f"give a {argument.kind}, without a unit{about}"
    return f"give a {argument.kind}{about}"


def _missing(
    name: str, reading: _Reading, arguments: Sequence[Argument], operands: Sequence[Argument]
) -> list[str]:
    absent = list(operands[len(reading.operands) :])
    absent += [a for a in arguments if a.is_option and a.word not in reading.given]
    needed = [argument for argument in absent if argument.required]
    return [
        f"{name} needs {a.word}" + (f": {a.help}" if a.help else "")
        for a in needed
        if not (a.many and not a.is_option)
    ]


def _other_command(name: str, operands: Sequence[str], commands: Iterable[str]) -> str:
    """A command of two words whose second one is misspelt."""
    longer = {c.removeprefix(f"{name} "): c for c in commands if c.startswith(f"{name} ")}
    close = get_close_matches(operands[0], longer, n=1)
    return f"; did you mean 'hsr8 {longer[close[0]]}'?" if close else ""


def _after(option: str, words: Sequence[str]) -> str | None:
    """The word that follows `option`, if one does."""
    return next((b for a, b in pairwise(words) if a == option), None)


def _as_value(word: str, options: dict[str, Argument]) -> str:
    """The option that has such a value, if one has."""
    for option in options.values():
        close = get_close_matches(word, option.choices, n=1)
        if close:
            return f"; did you mean '{option.word} {close[0]}'?"
    return ""


def is_option(word: str) -> bool:
    """Whether it begins with dashes and is neither a dash alone nor a negative number."""
    return word.startswith("-") and word != "-" and not _NEGATIVE.match(word)
