"""``hsr8 robot inspect``: guessed roles of a robot's parts, and the robot that results."""

from dataclasses import asdict

from rich.console import Console

from hsr8.cli import tables
from hsr8.cli.output_file import require_file_name, require_new, writing
from hsr8.cli.robot_options import RobotInspect
from hsr8.errors import ModelError, UsageError
from hsr8.files import atomic
from hsr8.files.text import shell_line
from hsr8.robots.inspection import Inspection, description_text, facts, inspect, load_inspected
from hsr8.robots.loaded import LoadedRobot
from hsr8.show.image import write_png
from hsr8.show.portrait import portrait


def main(options: RobotInspect) -> int:
    """Print roles and derived numbers; write the description and draw the robot.

    A description is also written for a robot that is refused, to be corrected.
    """
    _require_outputs(options)
    inspection = inspect(options.file)
    if inspection.stated and options.write is not None:
        raise UsageError(f"--write {options.write}: {options.file} is a description already")
    robot, refusal = None, None
    try:
        inspection, robot = load_inspected(inspection)
    except ModelError as error:
        refusal = error
    _show(options, inspection, robot, refusal)
    if options.write is not None and inspection.description is not None:
        words = ["hsr8", "robot", "inspect", options.file]
        text = description_text(inspection, options.write, shell_line(words))
        with writing("--write", options.write):
            atomic.write_text(options.write, text)
        if not options.json:
            print(f"description {options.write}")
    if refusal is not None:
        raise refusal
    if options.image is not None and robot is not None:
        image = portrait(robot)
        with writing("--image", options.image):
            write_png(options.image, image)
        if not options.json:
            print(f"image       {options.image}")
    if not options.json:
        words = ["hsr8", "robot", "inspect", options.file, "--write", "robot.toml"]
        if inspection.stated or options.write is not None:
            words = ["hsr8", "robot", "check", str(options.write or options.file)]
        print(f"next        {shell_line(words)}")
    return 0


def _require_outputs(options: RobotInspect) -> None:
    """Check the names of the output files.

    Raises:
        UsageError: a name is invalid, or the description exists.
    """
    if options.write is not None:
        require_file_name("--write", options.write, (".toml",))
        require_new("--write", options.write)
    if options.image is not None:
        require_file_name("--image", options.image, (".png",))


def _show(
    options: RobotInspect,
    inspection: Inspection,
    robot: LoadedRobot | None,
    refusal: ModelError | None,
) -> None:
    """Print the findings, and the numbers of the robot unless it is refused."""
    findings = [asdict(finding) for finding in inspection.findings]
    numbers = None if robot is None else facts(robot)
    notes = list(inspection.notes if robot is None else robot.notes)
    if options.json:
        result = {"model": str(inspection.model), "findings": findings, "robot": numbers}
        print(atomic.dumps({**result, "notes": notes, "refusal": refusal and str(refusal)}))
        return
    console = Console(highlight=False)
    if inspection.stated:
        stated = inspection.require_description().model_dump(exclude_none=True)
        findings = [
            {"role": f["role"], "stated": stated.get(f["role"]), "guess": f.pop("part"), **f}
            for f in findings
        ]
    console.print(tables.rows(findings, str(inspection.model)))
    if numbers is not None:
        console.print(tables.facts(numbers))
    for note in notes:
        console.print(note, soft_wrap=True, markup=False)
