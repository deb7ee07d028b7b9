"""The command line ``hsr8``."""

import atexit
import gc
import importlib
import io
import os
import re
import sys
from collections.abc import Sequence
from contextlib import redirect_stderr, suppress
from typing import Any, get_args

import tyro

from hsr8.cli.options import BenchCompare, Command
from hsr8.cli.robot_options import Robot, RobotAction
from hsr8.errors import INTERRUPTED, Hsr8Error, UsageError
from hsr8.process.signals import like_ctrl_c
from hsr8.recording.crash import crash_report
from hsr8.suggestion import suggestion
from hsr8.version import VERSION

DESCRIPTION = f"""hsr8 {VERSION}: full-body simulator of a small humanoid that walks among moving \
obstacles and navigates with on-board sensors only.

First steps: `hsr8 doctor`, `hsr8 run quick`, `hsr8 render runs/quick`, `hsr8 replay runs/quick`.

`hsr8 --version` prints the version, `hsr8 --tyro-print-completion bash` the completion script \
of a shell: bash, zsh or fish.

Exit codes: 0 done or criteria met, 1 criteria missed or runs differ, 2 wrong usage or input, \
3 diverged or internal error, 130 interrupted."""
SIGPIPE_EXIT = 141  # the code of a program that SIGPIPE ends
COLLECT_AFTER = 20_000  # new objects; the default takes 0.3 s more, most of it in imports
SHELLS = ("bash", "zsh", "fish")
CONFIG = (
    tyro.conf.FlagCreatePairsOff,
    tyro.conf.OmitArgPrefixes,
    tyro.conf.OmitSubcommandPrefixes,
)


def _words(kind: type[object], separator: str) -> str:
    """Return the words of a class name in lower case."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", separator, kind.__name__).lower()


COMMANDS: dict[str, type[Command]] = {_words(kind, "-"): kind for kind in get_args(Command)}

GROUPS: dict[str, tuple[str, ...]] = {
    "Run": ("run", "sweep", "list", "check"),
    "Inspect": ("info", "replay", "render", "plot", "export", "verify", "diff"),
    "Compare": ("compare", "bench"),
    "Robots": ("robot",),
    "Setup": ("doctor", "schema", "color-table"),
}
ACTIONS = {
    "robot": [kind.__name__.removeprefix("Robot").lower() for kind in get_args(RobotAction)],
    "bench": ["compare"],
}


def entry(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        arguments: words without the program's name; those of the process by default.

    Returns:
        The exit code, see `DESCRIPTION`.
    """
    gc.set_threshold(COLLECT_AFTER)
    atexit.register(gc.freeze)  # no last collection: it takes a tenth of a second
    sys.stdout = sys.stdout or io.StringIO()  # None where the stream is closed
    sys.stderr = sys.stderr or io.StringIO()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # file names may hold any bytes
            stream.reconfigure(errors="backslashreplace")
    try:
        code = _run(list(sys.argv[1:] if arguments is None else arguments))
        print(end="", flush=True)
    except OSError as error:  # a closed pipe or a full disk
        with suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(error, BrokenPipeError):
            return SIGPIPE_EXIT
        with suppress(OSError):
            file = error.filename or "standard output"
            print(f"hsr8: cannot write {file}: {error.strerror}", file=sys.stderr)
        return Hsr8Error.exit_code
    return code


def _run(words: list[str]) -> int:
    """Run the command of a command line; return its exit code."""
    try:
        with crash_report():
            command = parse(words)
            if command is None:
                return 0
            # Not before: MuJoCo, Rerun and SciPy take seconds.
            options = command.action if isinstance(command, Robot) else command
            name = "compare" if type(options) is BenchCompare else _words(type(options), "_")
            module = importlib.import_module(f"hsr8.cli.{name}")
            with like_ctrl_c():
                code: int = module.main(options)
    except Hsr8Error as error:
        notes = getattr(error, "__notes__", [])
        print(", ".join([f"hsr8: {error}", *notes]), file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print("hsr8: interrupted", file=sys.stderr)
        return INTERRUPTED
    except SystemExit as stop:  # raised by rich for a closed pipe
        raise BrokenPipeError from stop
    return code


def parse(words: Sequence[str]) -> Command | BenchCompare | None:
    """Parse a command line.

    Returns:
        The options of the command; None where help, version or a completion script was printed.

    Raises:
        UsageError: the command line is wrong.
    """
    name, *rest = words or ["--help"]
    if name == "--version":
        print(f"hsr8 {VERSION}")
        return None
    if name in COMMANDS:
        action = _action(name, rest) if name in ACTIONS else []
        if action == ["compare"]:
            return _parse(BenchCompare, "hsr8 bench compare", rest[1:])
        help_wanted = not {"-h", "--help"}.isdisjoint(rest)
        return _parse(COMMANDS[name], f"hsr8 {name}", [*action, "--help"] if help_wanted else rest)
    if name in ("-h", "--help"):
        print(overview())
        return None
    if name == "--tyro-print-completion":
        if tuple(rest) not in [(shell,) for shell in SHELLS]:
            raise UsageError(f"{name}: got {' '.join(rest)!r}; expected {', '.join(SHELLS)}")
        return _parse(Command, "hsr8", words)
    hint = suggestion(name, list(COMMANDS))
    raise UsageError(f"{name}: unknown command{hint} (commands: {', '.join(COMMANDS)})")


def overview() -> str:
    """Return the description of the program and its commands by group."""
    lines = ["usage: hsr8 COMMAND ...", "", DESCRIPTION]
    for group, names in GROUPS.items():
        docs = [(name, str(COMMANDS[name].__doc__).partition("\n")[0]) for name in names]
        lines += ["", group, *(f"  {name:<12}{doc}" for name, doc in docs)]
    return "\n".join([*lines, "", "`hsr8 COMMAND --help` lists the options of a command."])


def _action(name: str, words: Sequence[str]) -> list[str]:
    """Return the command after ``hsr8 robot`` or ``hsr8 bench``; none before options.

    Raises:
        UsageError: the command is unknown.
    """
    first, actions = "".join(words[:1]), ACTIONS[name]
    if first in actions:
        return [first]
    if first and not first.startswith("-"):
        hint = suggestion(first, actions)
        names = ", ".join(actions)
        raise UsageError(f"{name} {first}: unknown command{hint} (commands: {names})")
    return []


def _parse(
    kind: Any, prog: str, words: Sequence[str], **options: Any
) -> Command | BenchCompare | None:
    """Let tyro parse; turn the box that it prints about a mistake into a `UsageError`."""
    box = io.StringIO()
    try:
        with redirect_stderr(box):
            command: Command | BenchCompare = tyro.cli(
                kind, prog=prog, args=words, config=CONFIG, **options
            )
            return command
    except SystemExit as stop:
        if not stop.code:
            return None
    _, *rows = re.sub(r"\x1b\[[\d;]*m", "", box.getvalue()).splitlines()  # without the title
    lines = [row[2:].rstrip("│ ") for row in rows]
    raise UsageError("\n  ".join(line for line in lines if re.search(r"\w", line)))
