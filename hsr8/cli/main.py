"""The command line ``hsr8``."""

import importlib
import os
import sys
from collections.abc import Sequence
from typing import Annotated, TextIO

import tyro

from hsr8 import __version__
from hsr8.cli import options
from hsr8.cli.crash import CrashReport
from hsr8.errors import Hsr8Error

DESCRIPTION = f"""hsr8 {__version__}: a small humanoid walks among moving obstacles and sees \
only through its own camera.

First steps: `hsr8 doctor`, `hsr8 run quick`, `hsr8 render runs/quick`, `hsr8 replay runs/quick`."""

# A command's module is imported when it is called: MuJoCo, Rerun and SciPy take seconds.
MODULES: dict[type, str] = {
    options.Run: "hsr8.cli.run",
    options.List: "hsr8.cli.list",
    options.Check: "hsr8.cli.check",
    options.CheckReplay: "hsr8.cli.check_replay",
    options.Doctor: "hsr8.cli.doctor",
    options.Render: "hsr8.cli.render",
    options.Replay: "hsr8.cli.replay",
    options.Plot: "hsr8.cli.plot",
    options.Colours: "hsr8.cli.colours",
}
INTERRUPTED = 130
READER_LEFT = 141  # as of a program that SIGPIPE ends
CHECK_REPLAY = "check replay"  # a command of two words beside `check`

Commands = (
    Annotated[options.Run, tyro.conf.subcommand("run")]
    | Annotated[options.List, tyro.conf.subcommand("list")]
    | Annotated[options.Check, tyro.conf.subcommand("check")]
    | Annotated[options.CheckReplay, tyro.conf.subcommand(CHECK_REPLAY)]
    | Annotated[options.Doctor, tyro.conf.subcommand("doctor")]
    | Annotated[options.Render, tyro.conf.subcommand("render")]
    | Annotated[options.Replay, tyro.conf.subcommand("replay")]
    | Annotated[options.Plot, tyro.conf.subcommand("plot")]
    | Annotated[options.Colours, tyro.conf.subcommand("colours")]
)


def entry(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        arguments: without the program's name; those of the process by default.

    Returns:
        0 done or passed, 1 ran but failed its criteria, 2 usage or scenario error,
        3 diverged or internal error, 130 interrupted.
    """
    try:
        code = _answer(list(sys.argv[1:] if arguments is None else arguments))
        for stream in (sys.stdout, sys.stderr):
            print(end="", file=stream, flush=True)
    except OSError as error:
        for stream in (sys.stdout, sys.stderr):
            _drop_unread(stream)
        if isinstance(error, BrokenPipeError):
            return READER_LEFT
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
            module = importlib.import_module(MODULES[type(command)])
            code: int = module.main(command)
    except Hsr8Error as error:
        print(f"hsr8: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print("hsr8: interrupted", file=sys.stderr)
        return INTERRUPTED
    except SystemExit as stop:  # rich's word for a reader that has left
        raise BrokenPipeError from stop
    return code


def _parsed(given: list[str]) -> options.Command | int:
    """The command, or the exit code where help or a mistake has been told instead."""
    try:
        return tyro.cli(
            Commands,
            prog="hsr8",
            description=DESCRIPTION,
            args=given or ["--help"],
            config=(tyro.conf.FlagCreatePairsOff,),
        )
    except SystemExit as stop:
        return stop.code if isinstance(stop.code, int) else 2


def _drop_unread(stream: TextIO) -> None:
    """What is still to be written, at the latest when Python ends, may have no place."""
    try:
        stream.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
