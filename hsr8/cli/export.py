"""``hsr8 export``: runs and robots in the formats of other tools."""

from pathlib import Path

from hsr8.cli.options import Export
from hsr8.cli.output_file import require_file_name, writing
from hsr8.errors import UsageError
from hsr8.export.urdf import urdf_of
from hsr8.recorder.files import atomic
from hsr8.robots.loaded import load_robot

DEFAULT_ROBOT = "hsr8"


def main(options: Export) -> int:
    """Write the exports and print their paths.

    Raises:
        UsageError: an option is invalid, or a target exists.
        ModelError: the robot is unknown or invalid.
    """
    if options.urdf is None:
        raise UsageError("export: nothing to export; expected --urdf FILE")
    if options.urdf is not None:
        _urdf(options.urdf, options.robot or DEFAULT_ROBOT)
    if options.json:
        print(atomic.dumps({"urdf": str(options.urdf)}))
    else:
        print(f"urdf        {options.urdf}")
    return 0


def _urdf(file: Path, robot: str) -> None:
    require_file_name("--urdf", file, (".urdf",))
    urdf = urdf_of(load_robot(robot), f"{file.stem}_meshes")
    for path in (file, file.parent / f"{file.stem}_meshes"):
        if path.exists():
            raise UsageError(f"--urdf {path}: exists; expected a new file")
    with writing("--urdf", file):
        urdf.write(file)
