"""``hsr8 completion``: the commands and what they take, for the tab key of a shell."""

import shlex
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from hsr8.cli.options import Completion
from hsr8.cli.signature import Argument, signature

Place = tuple[str, str]  # a command, and the option that a value belongs to or nothing
SCENARIO, RUNS = "SCENARIO", ("RUN", "A", "B")


@dataclass(frozen=True, slots=True)
class Offer:
    """What a place of the command line can hold.

    Attributes:
        words: to choose from.
        files: what else, by its kind in the table of a shell; empty for nothing.
    """

    words: tuple[str, ...]
    files: str = ""


def main(options: Completion) -> int:
    """Print the script."""
    from hsr8.cli.main import COMMANDS  # noqa: PLC0415  which imports this module

    print(SHELLS[options.shell]({name: kind for name, (kind, _) in COMMANDS.items()}), end="")
    return 0


def _offers(commands: dict[str, type]) -> Iterator[tuple[Place, Offer]]:
    """What can be the value of each option, and the operand of each command."""
    for name, kind in commands.items():
        for argument in signature(kind):
            if argument.is_option and argument.kind != "switch":
                yield (name, argument.word), _offer(argument)
        operand = next((a for a in signature(kind) if not a.is_option), None)
        if operand is not None:
            yield (name, ""), _offer(operand, _second_words(name, commands))


def _offer(argument: Argument, more: tuple[str, ...] = ()) -> Offer:
    if argument.word == SCENARIO:
        from hsr8.scenario.loader import built_in_names  # noqa: PLC0415  half a second

        return Offer((*built_in_names(), *more), "any")
    if argument.word in RUNS:
        return Offer(more, "folder")
    return Offer((*argument.choices, *more), "any" if argument.kind == "path" else "")


def _second_words(name: str, commands: dict[str, type]) -> tuple[str, ...]:
    """Of commands of two words that begin with a command of one."""
    return tuple(c.removeprefix(f"{name} ") for c in commands if c.startswith(f"{name} "))


def _options(kind: type) -> str:
    return " ".join([*(a.word for a in signature(kind) if a.is_option), "--help"])


def _first_words(commands: dict[str, type]) -> str:
    return " ".join(name for name in commands if " " not in name)


def _two_words(commands: dict[str, type]) -> list[list[str]]:
    return [name.split() for name in commands if " " in name]


BASH = """\
_hsr8() {{
    local IFS=$' \t\n' word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}}
    local command=${{COMP_WORDS[1]}} words= files= options=
    {two}
    case "$command" in
{options}
    esac
    if (( COMP_CWORD == 1 )); then
        words="{first} --help --version"
    elif [[ $word == -* ]]; then
        words=$options
    else
        [[ $before == --* && " $options " == *" $before "* ]] || before=
        case "$command,$before" in
{places}
            *) words=$options ;;
        esac
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word"
        [[ -n $files ]] && compgen -A "$files" -- "$word")
    [[ -n $files ]] && compopt -o filenames 2> /dev/null
    return 0
}}
complete -F _hsr8 hsr8
"""
ZSH = """\
#compdef hsr8
_hsr8() {{
    local word=$words[CURRENT] before=$words[CURRENT-1] command=$words[2] options
    {two}
    case "$command" in
{options}
    esac
    if (( CURRENT == 2 )); then
        compadd -- {first} --help --version
    elif [[ $word == -* ]]; then
        compadd -- ${{=options}}
    else
        [[ $before == --* && " $options " == *" $before "* ]] || before=
        case "$command,$before" in
{places}
            *) compadd -- ${{=options}} ;;
        esac
    fi
}}
if [[ $funcstack[1] == _hsr8 ]]; then _hsr8 "$@"; else compdef _hsr8 hsr8; fi
"""


def _bash(commands: dict[str, type]) -> str:
    actions = {"any": " files=file", "folder": " files=directory", "": ""}
    return _filled(
        BASH,
        commands,
        two="[[ $command == {0} && ${{COMP_WORDS[2]}} == {1} && $COMP_CWORD -gt 2 ]] "
        "&& command='{0} {1}'",
        place=lambda offer: f"words={shlex.quote(' '.join(offer.words))}{actions[offer.files]}",
    )


def _zsh(commands: dict[str, type]) -> str:
    actions = {"any": "_files", "folder": "_files -/", "": ":"}

    def place(offer: Offer) -> str:
        words = f"compadd -- {' '.join(offer.words)}; " if offer.words else ""
        return words + actions[offer.files]

    return _filled(
        ZSH,
        commands,
        two="[[ $command == {0} && $words[3] == {1} ]] && (( CURRENT > 3 )) && command='{0} {1}'",
        place=place,
    )


def _filled(
    script: str, commands: dict[str, type], *, two: str, place: Callable[[Offer], str]
) -> str:
    return script.format(
        two="\n    ".join(two.format(*words) for words in _two_words(commands)),
        options="\n".join(
            f"        {shlex.quote(name)}) options='{_options(kind)}' ;;"
            for name, kind in commands.items()
        ),
        first=_first_words(commands),
        places="\n".join(
            f"            {shlex.quote(','.join(where))}) {place(offer)} ;;"
            for where, offer in _offers(commands)
        ),
    )


def _fish(commands: dict[str, type]) -> str:
    lines = ["complete -c hsr8 -f"]
    for name in _first_words(commands).split():
        told = (commands[name].__doc__ or "").splitlines()[0]
        lines.append(f"complete -c hsr8 -n __fish_use_subcommand -a {name} -d {shlex.quote(told)}")
    offers = dict(_offers(commands))
    for name, kind in commands.items():
        seen = shlex.quote(
            " && ".join(f"__fish_seen_subcommand_from {word}" for word in name.split())
        )
        head = f"complete -c hsr8 -n {seen}"
        for argument in signature(kind):
            told = shlex.quote(argument.help.splitlines()[0])
            if argument.is_option:
                more = "" if argument.kind == "switch" else _fish_value(offers[name, argument.word])
                lines.append(f"{head} -l {argument.word[2:]}{more} -d {told}")
        if (name, "") in offers:
            lines.append(head + _fish_value(offers[name, ""]).removeprefix(" -x"))
    return "\n".join(lines) + "\n"


def _fish_value(offer: Offer) -> str:
    words = list(offer.words)
    if offer.files == "folder":
        words.append("(__fish_complete_directories)")
    files = " -r -F" if offer.files == "any" else " -x"
    return files + (f" -a {shlex.quote(' '.join(words))}" if words else "")


SHELLS = {"bash": _bash, "zsh": _zsh, "fish": _fish}
