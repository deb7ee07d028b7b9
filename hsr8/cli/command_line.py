"""Settings of a scenario, and the command line of a run, from the options of a command."""

import shlex
from collections.abc import Iterable, Sequence
from typing import Any

from hsr8.cli.options import Check, Run, Sweep
from hsr8.errors import UsageError
from hsr8.recorder.log_level import LogLevel


def settings(options: Run | Check | Sweep) -> tuple[str, ...]:
    """Return every ``key=value`` of every ``--set``.

    Raises:
        UsageError: a ``--set`` has no value.
    """
    if () in options.set:
        raise UsageError("--set: missing value; expected KEY=VALUE")
    return flat(options.set)


def flat(groups: Iterable[Iterable[str]]) -> tuple[str, ...]:
    """Return all values of a repeated option."""
    return tuple(value for group in groups for value in group)


def run_words(options: Run | Check | Sweep, more: Sequence[str] = ()) -> tuple[str, ...]:
    """Return the words of the command line that makes such a run, without its seed.

    Args:
        options: as given.
        more: further settings.
    """
    words = ["hsr8", "run", options.scenario]
    if not isinstance(options, Check):
        for flag, value in (
            ("--duration", options.duration),
            ("--body", options.body),
            ("--camera", options.camera),
        ):
            if value is not None:
                words += [flag, str(value)]
    for group in (*options.set, *((setting,) for setting in more)):
        words += ["--set", *group]
    return tuple(words)


def run_command(options: Run | Check, seed: int) -> tuple[str, ...]:
    """Return the words, quoted for a shell, of the command line that makes exactly this run."""
    head, name, scenario, *rest = run_words(options)
    words = [head, name, scenario, "--seed", str(seed), *rest]
    if isinstance(options, Run):
        words += [] if options.out == Run.out else ["--out", str(options.out)]
        words += ["--no-log"] if options.no_log else []
        words += ["--log-level", options.log_level] if options.log_level else []
    return tuple(shlex.quote(word) for word in words)


def option_tables(options: Run | Sweep) -> dict[str, dict[str, Any]]:
    """Return the settings that each option stands for, by option; ``--set`` overrides them."""
    tables: dict[str, dict[str, Any]] = {}
    if options.duration is not None:
        tables["--duration"] = {"duration": options.duration}
    if options.body is not None:
        tables["--body"] = {"robot": {"body": options.body}}
    if options.camera is not None:
        tables["--camera"] = {"camera": {"source": options.camera}}
    return tables


def log_level(options: Run) -> LogLevel | None:
    """Return the level of the log; None for no log.

    Raises:
        UsageError: the log is to be viewed and there is none.
    """
    if not options.no_log:
        return LogLevel(options.log_level or LogLevel.STANDARD)
    if options.view is not None:
        raise UsageError("--view: shows the log, got --no-log; leave out one of them")
    return None
