"""Command lines taken apart, and put together again for people to type."""

import re
import shlex
from collections.abc import Iterable, Sequence
from typing import Any

from hsr8.cli.options import Check, Run, Sweep
from hsr8.errors import UsageError
from hsr8.recorder.log_level import LogLevel


def settings(options: Run | Check | Sweep) -> tuple[str, ...]:
    """Every ``key=value`` of every ``--set``."""
    return flat(options.set)


def flat(groups: Iterable[Iterable[str]]) -> tuple[str, ...]:
    """Every value of an option that may be repeated."""
    return tuple(value for group in groups for value in group)


def run_words(options: Run | Check | Sweep, more: Sequence[str] = ()) -> tuple[str, ...]:
    """Words of the command line that makes such a run, but for its seed.

    Args:
        options: as they were given.
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
    """Words, quoted for a shell, of the command line that makes exactly this run."""
    head, name, scenario, *rest = run_words(options)
    words = [head, name, scenario, "--seed", str(seed), *rest]
    if isinstance(options, Run):
        words += _left_behind(options)
    return tuple(shlex.quote(word) for word in words)


def _left_behind(options: Run) -> list[str]:
    """Words that say what a run writes, and where."""
    words = [] if options.out == Run.out else ["--out", str(options.out)]
    words += ["--no-log"] if options.no_log else []
    words += ["--log-level", options.log_level] if options.log_level else []
    words += ["--checkpoint", options.checkpoint] if options.checkpoint else []
    return words


def option_tables(options: Run | Sweep) -> dict[str, dict[str, Any]]:
    """What the options set in the scenario, by option; ``--set`` comes after them."""
    tables: dict[str, dict[str, Any]] = {}
    if options.duration is not None:
        tables["--duration"] = {"duration": options.duration}
    if options.body is not None:
        tables["--body"] = {"robot": {"body": options.body}}
    if options.camera is not None:
        tables["--camera"] = {"camera": {"source": options.camera}}
    return tables


def log_level(options: Run) -> LogLevel | None:
    """How much is logged; None for nothing."""
    return None if options.no_log else LogLevel(options.log_level or LogLevel.STANDARD)


def require_viewed(options: Run, log: LogLevel | None) -> None:
    """Make sure that there is something for the viewer to show, if one was asked for.

    Args:
        options: as they were given.
        log: how much is logged.

    Raises:
        UsageError: there is nothing.
    """
    if options.view is not None and log is None:
        way = "leave out --no-log" if options.no_log else "give --log-level"
        raise UsageError(f"--view shows the log, and this run writes none: {way}")


def checkpoint_period(options: Run) -> int:
    """How often the whole run is saved [s]; 0 for never.

    Raises:
        UsageError: what was given is no such period.
    """
    if not options.checkpoint:
        return 0
    match = re.fullmatch(r"(?:every=)?([1-9]\d{0,5})", options.checkpoint, re.ASCII)
    if match is None:
        raise UsageError(
            f"--checkpoint {options.checkpoint}: give whole simulated seconds, e.g. every=10"
        )
    return int(match[1])
