"""``hsr8 export``: runs and robots in the formats of other tools."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hsr8.cli.options import Export
from hsr8.cli.output_file import require_file_name, writing
from hsr8.errors import UsageError
from hsr8.export.bag import write_bag
from hsr8.export.csv_tables import write_csv
from hsr8.export.lerobot import write_lerobot
from hsr8.export.urdf import urdf_of
from hsr8.recorder.files import atomic
from hsr8.recorder.run.run_reader import Run, open_run
from hsr8.robots.loaded import load_robot

DEFAULT_ROBOT = "hsr8"


def main(options: Export) -> int:
    """Write the exports and print their paths.

    Raises:
        UsageError: an option is invalid, a target exists, or a run cannot be read.
        ModelError: the robot is unknown or invalid.
    """
    given = {
        "--urdf": options.urdf,
        "--bag": options.bag,
        "--csv": options.csv,
        "--lerobot": options.lerobot,
    }
    targets = {option: path for option, path in given.items() if path is not None}
    if not targets:
        raise UsageError("export: nothing to export; expected --bag, --csv, --lerobot or --urdf")
    for option, path in targets.items():
        _require_new(option, path)
    runs = [open_run(path) for path in options.runs]
    if options.urdf is not None:
        _urdf(options.urdf, options.robot or DEFAULT_ROBOT)
    if options.bag is not None:
        run = _only(runs, "--bag")
        with _folder("--bag", options.bag):
            write_bag(run, options.bag)
    if options.csv is not None:
        run = _only(runs, "--csv")
        with _folder("--csv", options.csv):
            write_csv(run, options.csv)
    if options.lerobot is not None:
        if not runs:
            raise UsageError("--lerobot: got 0 runs; expected at least one")
        with _folder("--lerobot", options.lerobot):
            write_lerobot(runs, options.lerobot)
    if options.json:
        print(atomic.dumps({option.removeprefix("--"): str(p) for option, p in targets.items()}))
    else:
        for option, path in targets.items():
            print(f"{option.removeprefix('--'):<12}{path}")
    return 0


def _require_new(option: str, path: Path) -> None:
    if path.exists():
        raise UsageError(f"{option} {path}: exists; expected a new name")
    if not path.parent.is_dir():
        raise UsageError(f"{option} {path}: cannot be written: no folder {path.parent}")


def _only(runs: list[Run], option: str) -> Run:
    if len(runs) != 1:
        raise UsageError(f"{option}: got {len(runs)} runs; expected one")
    return runs[0]


@contextmanager
def _folder(option: str, path: Path) -> Iterator[None]:
    """Write a new folder; remove it if that fails."""
    try:
        with writing(option, path):
            yield
    except BaseException:
        shutil.rmtree(path, ignore_errors=True)
        raise


def _urdf(file: Path, robot: str) -> None:
    require_file_name("--urdf", file, (".urdf",))
    meshes = f"{file.stem}_meshes"
    _require_new("--urdf", file.parent / meshes)
    urdf = urdf_of(load_robot(robot), meshes)
    with writing("--urdf", file):
        urdf.write(file)
