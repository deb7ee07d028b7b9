"""Command lines taken apart, and put together again for people to type."""

import shlex

from hsr8.cli.options import Check, Run


def settings(options: Run | Check) -> tuple[str, ...]:
    """Every ``key=value`` of every ``--set``."""
    return tuple(setting for group in options.set for setting in group)


def run_command(options: Run | Check, seed: int) -> tuple[str, ...]:
    """Words, quoted for a shell, of the command line that makes exactly this run."""
    words = ["hsr8", "run", options.scenario, "--seed", str(seed)]
    if isinstance(options, Run):
        for flag, value in (
            ("--duration", options.duration),
            ("--body", options.body),
            ("--camera", options.camera),
        ):
            if value is not None:
                words += [flag, str(value)]
    for group in options.set:
        words += ["--set", *group]
    return tuple(shlex.quote(word) for word in words)
