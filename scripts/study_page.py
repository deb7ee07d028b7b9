"""Shared by the studies: seeds on the command line, and the header of a page of results."""

import argparse
import platform
import re
import shlex
import sys
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path

from hsr8.errors import UsageError
from hsr8.evaluation.sweep.seeds import parse_seeds

RESULTS = Path(__file__).resolve().parents[1] / "docs" / "results"
PACKAGES = ("hsr8", "mujoco", "numpy", "pin")
STAND_INS = ("robot.body=kinematic", "camera.source=analytic")
"""Settings of a run without physics and images."""


def seeds_of(text: str) -> tuple[int, ...]:
    """Return the seeds of ``1000:1020``, ``1,5,9`` or ``1000-1019`` (inclusive); none of "".

    Raises:
        ValueError: `text` is malformed.
    """
    if not text:
        return ()
    closed = re.sub(r"(\d+)-(\d+)", lambda m: f"{m[1]}:{int(m[2]) + 1}", text)
    try:
        return parse_seeds(closed)
    except UsageError as error:
        raise ValueError(str(error)) from error


class _Seeds(argparse.Action):
    """Collects the seeds of several words in one list."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Iterable[tuple[int, ...]],
        option: str | None = None,
    ) -> None:
        setattr(namespace, self.dest, [seed for group in values for seed in group])


def add_seeds(parser: argparse.ArgumentParser, default: Iterable[int] = (0,)) -> None:
    """Add ``--seeds 1000-1019`` or ``--seeds 1000 1001``, a list of integers, to `parser`."""
    parser.add_argument(
        "--seeds",
        action=_Seeds,
        type=seeds_of,
        nargs="+",
        default=list(default),
        help="N, FIRST-LAST, or A:B for A to B-1",
    )


def environment(packages: Iterable[str] = PACKAGES) -> str:
    """Return the versions of `packages` and of Python, and the architecture."""
    versions = ", ".join(f"{name} {version(name)}" for name in packages)
    return f"{versions}; Python {platform.python_version()}, {platform.machine()}"


def command_line() -> str:
    """Return the command that repeats this study from the repository's root."""
    return shlex.join(["python", f"scripts/{Path(sys.argv[0]).name}", *sys.argv[1:]])
