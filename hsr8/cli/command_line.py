"""Settings of a scenario, and command lines to repeat a run, from the options of a command."""

from collections.abc import Iterable, Sequence
from dataclasses import fields, replace
from typing import Any

from hsr8.cli.options import Bench, Check, Run, RunOptions, ScenarioOptions, Sweep
from hsr8.errors import UsageError


def settings(options: ScenarioOptions | Bench) -> tuple[str, ...]:
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


def command_words(options: Run | Sweep | Bench) -> tuple[str, ...]:
    """Return the words of the command line with these options and the default output."""
    options = replace(options, json=False, quiet=False)
    words = ["hsr8", type(options).__name__.lower()]
    for field in fields(options):
        flag, value = f"--{field.name.replace('_', '-')}", getattr(options, field.name)
        if field.name == "scenario":
            words.append(value)
            continue
        if value == field.default:
            continue
        for group in value if isinstance(value, tuple) else [(value,)]:
            words += [flag, *map(str, group)] if value is not True else [flag]
    return tuple(words)


def run_options(options: Check | Sweep, seed: int | None, more: Sequence[str] = ()) -> Run:
    """Return the options of ``hsr8 run`` for the same scenario and further settings."""
    shared = RunOptions if isinstance(options, Sweep) else ScenarioOptions
    given = {field.name: getattr(options, field.name) for field in fields(shared)}
    given["set"] = (*options.set, *((setting,) for setting in more))
    return Run(**given, seed=seed)


def option_tables(options: ScenarioOptions) -> dict[str, dict[str, Any]]:
    """Return the settings that each option stands for, by option; ``--set`` overrides them."""
    tables: dict[str, dict[str, Any]] = {"--robot": {"robot": {"model": options.robot}}}
    if isinstance(options, RunOptions):
        tables |= {
            "--duration": {"duration": options.duration},
            "--body": {"robot": {"body": options.body}},
            "--camera": {"camera": {"source": options.camera}},
        }
    return {flag: table for flag, table in tables.items() if getattr(options, flag[2:]) is not None}
