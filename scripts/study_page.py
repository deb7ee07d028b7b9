"""The command line of a study of walks, and the page that its table goes to."""

import argparse
import platform
import sys
from importlib.metadata import version
from pathlib import Path

RESULTS = Path(__file__).resolve().parents[1] / "docs" / "results"


def options_of(description: str, duration: float, page: str) -> argparse.Namespace:
    """Seeds, duration and whether to write `page`."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--seeds", type=int, nargs="+", default=[0])
    parser.add_argument("--duration", type=float, default=duration, help="per seed and row [s]")
    parser.add_argument("--write", action="store_true", help=f"write {page}")
    return parser.parse_args()


def write_page(
    page: str, title: str, text: str, table: list[str], options: argparse.Namespace
) -> None:
    """Write a page of results with versions and the command that repeats them."""
    versions = ", ".join(f"{p} {version(p)}" for p in ("hsr8", "mujoco", "numpy", "pin"))
    seeds = " ".join(map(str, options.seeds))
    script = Path(sys.argv[0]).name
    lines = [
        f"# {title}",
        "",
        f"{versions}; Python {platform.python_version()}, {platform.machine()}.",
        "",
        text,
        "",
        f"    python scripts/{script} --seeds {seeds} --duration {options.duration:g} --write",
        "",
        *table,
        "",
    ]
    (RESULTS / page).write_text("\n".join(lines))
