"""What studies share: seeds on the command line, and the page that a table goes to."""

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
    """Seeds as a sweep takes them, ``1000:1020`` or ``1,5,9``; or ``1000-1019``, both included.

    No text, no seeds.

    Raises:
        ValueError: it is no such thing.
    """
    if not text:
        return ()
    closed = re.sub(r"(\d+)-(\d+)", lambda m: f"{m[1]}:{int(m[2]) + 1}", text)
    try:
        return parse_seeds(closed)
    except UsageError as error:
        raise ValueError(str(error)) from error


class _Seeds(argparse.Action):
    """Puts the seeds of several words into one list."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Iterable[tuple[int, ...]],
        option: str | None = None,
    ) -> None:
        setattr(namespace, self.dest, [seed for group in values for seed in group])


def add_seeds(parser: argparse.ArgumentParser, default: Iterable[int] = (0,)) -> None:
    """Let `parser` take ``--seeds 1000-1019`` or ``--seeds 1000 1001``, a list of integers."""
    parser.add_argument(
        "--seeds",
        action=_Seeds,
        type=seeds_of,
        nargs="+",
        default=list(default),
        help="N, FIRST-LAST, or A:B for A to B-1",
    )


def options_of(description: str, duration: float, page: str) -> argparse.Namespace:
    """Seeds, duration and whether to write `page`."""
    parser = argparse.ArgumentParser(description=description)
    add_seeds(parser)
    parser.add_argument("--duration", type=float, default=duration, help="per seed and row [s]")
    parser.add_argument("--write", action="store_true", help=f"write {page}")
    return parser.parse_args()


def environment(packages: Iterable[str] = PACKAGES) -> str:
    """Versions of `packages` and of Python, and the kind of machine."""
    versions = ", ".join(f"{name} {version(name)}" for name in packages)
    return f"{versions}; Python {platform.python_version()}, {platform.machine()}"


def command_line() -> str:
    """The command that repeats this study, from the repository's root."""
    return shlex.join(["python", f"scripts/{Path(sys.argv[0]).name}", *sys.argv[1:]])


def write_page(page: str, title: str, text: str, table: list[str]) -> None:
    """Write a page of results with versions and the command that repeats them."""
    lines = [f"# {title}", "", f"{environment()}.", "", text, "", f"    {command_line()}", ""]
    (RESULTS / page).write_text("\n".join([*lines, *table, ""]))
