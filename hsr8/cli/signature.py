"""What each command takes, read from its options, to judge and to complete command lines."""

from dataclasses import MISSING, Field, dataclass, fields
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import tyro

from hsr8.docstrings import docstrings

Kind = Literal["switch", "whole number", "number", "choice", "path", "text"]

KINDS: dict[Any, Kind] = {bool: "switch", int: "whole number", float: "number"}


@dataclass(frozen=True, slots=True)
class Argument:
    """One option or operand of a command.

    Attributes:
        word: an option with its dashes; of an operand, what the help calls it.
        kind: of its value; a switch takes none.
        choices: values that it can have, where they are few.
        help: what it is, with its unit.
        required: must be given.
        many: takes every value up to the next option.
    """

    word: str
    kind: Kind
    choices: tuple[str, ...]
    help: str
    required: bool
    many: bool

    @property
    def is_option(self) -> bool:
        """Whether it has a word of its own on the command line."""
        return self.word.startswith("-")


@cache
def signature(command: type) -> tuple[Argument, ...]:
    """Options and operands of a command, in the order of its help."""
    hints = get_type_hints(command, include_extras=True)
    told = {name: text.splitlines()[0] for name, text in docstrings(command).items()}
    return tuple(
        _argument(field, hints[field.name], told.get(field.name, "")) for field in fields(command)
    )


def _argument(field: Field[Any], hint: Any, docstring: str) -> Argument:
    marks: tuple[Any, ...] = ()
    if get_origin(hint) is Annotated:
        hint, *rest = get_args(hint)
        marks = tuple(rest)
    value, many = _of_each(hint, repeated=tyro.conf.UseAppendAction in marks)
    told = next((mark for mark in marks if hasattr(mark, "metavar")), None)
    if tyro.conf.Positional in marks:
        word = getattr(told, "metavar", None) or field.name.upper()
    else:
        word = "--" + (getattr(told, "name", None) or field.name).replace("_", "-")
    choices = get_args(value) if get_origin(value) is Literal else ()
    return Argument(
        word=word,
        kind="choice" if choices else KINDS.get(value, "text" if value is str else "path"),
        choices=choices,
        help=getattr(told, "help", None) or docstring,
        required=field.default is MISSING,
        many=many,
    )


def _of_each(hint: Any, *, repeated: bool) -> tuple[Any, bool]:
    """Type of one value, and whether any number of them follows one word."""
    if get_origin(hint) is Annotated:
        return _of_each(get_args(hint)[0], repeated=repeated)
    if get_origin(hint) in (UnionType, Union):
        (hint,) = (one for one in get_args(hint) if one is not NoneType)
    if get_origin(hint) is tuple:
        inner, deeper = _of_each(get_args(hint)[0], repeated=False)
        return inner, deeper or not repeated
    return hint, False
