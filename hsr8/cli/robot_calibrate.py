"""``hsr8 robot calibrate``: properties of a robot, measured in simulation."""

import os
import sys
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path

from rich.console import Console

from hsr8.cli import tables
from hsr8.cli.output_file import require_file_name, require_new, writing
from hsr8.cli.robot_options import RobotCalibrate
from hsr8.errors import UsageError
from hsr8.files import atomic
from hsr8.files.text import shell_line
from hsr8.robots.file.description import Calibration, read_description
from hsr8.robots.file.description_file import moved, with_calibration
from hsr8.robots.file.locate import find_description, robot_names
from hsr8.robots.loaded import build_robot
from hsr8.trials.calibration import calibrate
from hsr8.version import VERSION

UNITS = {
    "vx": "mps",
    "vx_backward": "mps",
    "vy": "mps",
    "wz": "radps",
    "turn_delay": "s",
    "lag": "s",
    "height_sigma": "m",
}


def main(options: RobotCalibrate) -> int:
    """Measure, print the results and write them into the description."""
    source = find_description(options.robot).resolve()
    description = read_description(source)
    target = _target(options, source)
    robot = build_robot(description.model_copy(update={"calibration": None}), source)
    number = 0

    def report(line: str) -> None:
        nonlocal number
        number += 1
        if not options.quiet:
            print(f"trial {number:3d}   {line}", file=sys.stderr, flush=True)

    measured, warnings = calibrate(robot, report)
    result = Calibration.model_validate(
        {
            "date": datetime.now(UTC).date().isoformat(),
            "version": VERSION,
            "command": shell_line(["hsr8", "robot", "calibrate", options.robot]),
            **asdict(measured),
        }
    )
    text = source.read_text("utf-8")
    if target != source:
        text = moved(text, source.parent, target.parent)
    with writing("--out" if options.out else "ROBOT", target):
        atomic.write_text(target, with_calibration(text, result))
    values = result.model_dump()
    if options.json:
        result_of = {"robot": robot.name, "file": str(target), "calibration": values}
        print(atomic.dumps({**result_of, "warnings": warnings}))
    elif not options.quiet:
        flat = {**values.pop("speed"), **values}
        named = {f"{key}_{UNITS[key]}" if key in UNITS else key: v for key, v in flat.items()}
        Console(highlight=False).print(tables.facts(named, robot.name))
        print("\n".join([*warnings, f"description {target}"]))
    return 0


def _target(options: RobotCalibrate, source: Path) -> Path:
    """Return the file to write.

    Raises:
        UsageError: it cannot be written, is shipped, or another description exists there.
    """
    if options.out is not None:
        require_file_name("--out", options.out, (".toml",))
        require_new("--out", options.out)
        return options.out.absolute()
    if options.robot in robot_names():
        raise UsageError(
            f"robot {options.robot} is shipped with hsr8; expected --out FILE with a new file, or "
            f"{source} in place of the name"
        )
    if not (os.access(source, os.W_OK) and os.access(source.parent, os.W_OK)):
        raise UsageError(f"{source}: cannot be written; expected --out FILE with a new file")
    return source
