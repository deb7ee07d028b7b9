"""The command line ``hsr8``."""

import atexit
import gc
import importlib
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import reduce
from operator import or_
from typing import Annotated, Any, TextIO

import tyro

from hsr8.cli import options
from hsr8.cli.crash import CrashReport
from hsr8.cli.guidance import hints, no_command
from hsr8.cli.loading import loading
from hsr8.cli.standard_output import nowhere, prepared
from hsr8.cli.wrong_line import is_option, mistakes
from hsr8.errors import Hsr8Error, UsageError
from hsr8.version import VERSION

DESCRIPTION = f"""hsr8 {VERSION}: a small humanoid walks among moving obstacles and sees \
only through its own camera.

First steps: `hsr8 doctor`, `hsr8 run quick`, `hsr8 render runs/quick`, `hsr8 replay runs/quick`."""

CHECK_REPLAY = "check replay"  # a command of two words beside `check`
# A command's module is imported when it is called: MuJoCo, Rerun and SciPy take seconds.
COMMANDS: dict[str, tuple[type, str]] = {
    "run": (options.Run, "hsr8.cli.run"),
    "sweep": (options.Sweep, "hsr8.cli.sweep"),
    "compare": (options.Compare, "hsr8.cli.compare"),
    "list": (options.List, "hsr8.cli.list"),
    "check": (options.Check, "hsr8.cli.check"),
    CHECK_REPLAY: (options.CheckReplay, "hsr8.cli.check_replay"),
    "info": (options.Info, "hsr8.cli.info"),
    "diff": (options.Diff, "hsr8.cli.diff"),
    "render": (options.Render, "hsr8.cli.render"),
    "replay": (options.Replay, "hsr8.cli.replay"),
    "plot": (options.Plot, "hsr8.cli.plot"),
    "colours": (options.Colours, "hsr8.cli.color_table"),
    "schema": (options.Schema, "hsr8.cli.schema"),
    "completion": (options.Completion, "hsr8.cli.completion"),
    "doctor": (options.Doctor, "hsr8.cli.doctor"),
    "bug-report": (options.BugReport, "hsr8.cli.bug_report"),
}
HELP = {"-h", "--help"}
VIEWS = ("native", "web")
MODULES = dict(COMMANDS.values())
INTERRUPTED = 130
SIGPIPE_EXIT = 141  # as of a program that SIGPIPE ends
CALLED: Any = reduce(
    or_, (Annotated[kind, tyro.conf.subcommand(name)] for name, (kind, _) in COMMANDS.items())
)


@dataclass(frozen=True)
class _Line:
    """What the parser makes of a command line."""

    command: Annotated[CALLED, tyro.conf.arg(name="")]
    # Told before the parser is asked; here for the help.
    version: Annotated[
        bool, tyro.conf.arg(help="show the version and exit", help_behavior_hint="")
    ] = False


def entry(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        arguments: without the program's name; those of the process by default.

    Returns:
        0 done or passed, 1 ran but failed its criteria, 2 usage or scenario error,
        3 diverged or internal error, 130 interrupted.
    """
    atexit.register(gc.freeze)  # an ending process has nothing to look for
    sys.stdout = prepared(sys.stdout)
    sys.stderr = sys.stderr or nowhere()
    if os.environ.get("COLUMNS", "1").strip("0") == "":
        del os.environ["COLUMNS"]  # no terminal's width: nothing would be shown
    try:
        code = _answer(list(sys.argv[1:] if arguments is None else arguments))
        for stream in (sys.stdout, sys.stderr):
            print(end="", file=stream, flush=True)
    except OSError as error:
        for stream in (sys.stdout, sys.stderr):
            _drop_unread(stream)
        if isinstance(error, BrokenPipeError):
            return SIGPIPE_EXIT
        with suppress(OSError):  # it may be standard error that takes no more
            print(f"hsr8: cannot write to standard output: {error.strerror}", file=sys.stderr)
        return Hsr8Error.exit_code
    return code


def _answer(given: list[str]) -> int:
    """Do what the command line says; its exit code."""
    if given[:2] == CHECK_REPLAY.split():
        given[:2] = [CHECK_REPLAY]
    try:
        with CrashReport():
            command = _parsed(given)
            if isinstance(command, int):
                return command
            with loading():
                module = importlib.import_module(MODULES[type(command)])
            code: int = module.main(command)
    except Hsr8Error as error:
        when = getattr(error, "__notes__", [])
        print(", ".join([f"hsr8: {error}", *when]), file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print("hsr8: interrupted", file=sys.stderr)
        return INTERRUPTED
    except SystemExit as stop:  # rich's word for a reader that has left
        raise BrokenPipeError from stop
    return code


def _parsed(given: list[str]) -> options.Command | int:
    """The command, or the exit code where help or a mistake has been told instead."""
    if given[:1] in (["--version"], ["version"]):
        print(f"hsr8 {VERSION}")
        return 0
    if given[:1] == ["help"]:
        given = [*given[1:2], "--help"]
    if given and not given[0].startswith("-") and given[0] not in COMMANDS:
        raise UsageError(no_command(given[0], given[1:], list(COMMANDS)))
    words = given
    if not words or not HELP.isdisjoint(words):
        words = [*(word for word in words[:1] if word in COMMANDS), "--help"]
    else:
        _judge(words)
    try:
        return parse(_for_the_parser(words))
    except SystemExit as stop:
        return stop.code if isinstance(stop.code, int) else 2


def _judge(words: list[str]) -> None:
    """Say what is wrong in a sentence, before the parser has to.

    Raises:
        UsageError: something is.
    """
    name = words[0]
    if name not in COMMANDS:
        raise UsageError(f"{name}: a command comes first (commands: {', '.join(COMMANDS)})")
    said = mistakes(words, {word: kind for word, (kind, _) in COMMANDS.items()})
    if said:
        more = [*hints(words), f"all that it takes: hsr8 {name} --help"]
        raise UsageError("\n  ".join([*said, *more]))


def _for_the_parser(given: list[str]) -> list[str]:
    """``--view`` alone means the window, and what follows an option may begin with a dash.

    `tyro` knows no options with an optional value, and takes a value such as -3:3 for an option.
    """
    words: list[str] = []
    for word, following in zip(given, [*given, ""][1:], strict=True):
        if words and words[-1].startswith("--") and word.startswith("-") and not is_option(word):
            words[-1] += f"={word}"
        else:
            words += ["--view", "native"] if word == "--view" and following not in VIEWS else [word]
    return words


def parse(arguments: Sequence[str]) -> options.Command:
    """Command and options of a command line.

    Raises:
        SystemExit: it is wrong, or asks for help; what there is to say has been said.
    """
    line = tyro.cli(
        _Line,
        prog="hsr8",
        description=DESCRIPTION,
        args=arguments,
        config=(
            tyro.conf.FlagCreatePairsOff,
            tyro.conf.OmitArgPrefixes,
            tyro.conf.OmitSubcommandPrefixes,
        ),
    )
    command: options.Command = line.command
    return command


def _drop_unread(stream: TextIO) -> None:
    """What is still to be written, at the latest when Python ends, may have no place."""
    try:
        stream.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
