"""``hsr8 robot check``: a robot stands and walks in every direction."""

import sys
from collections.abc import Sequence
from dataclasses import asdict

from rich.console import Console

from hsr8.cli import tables
from hsr8.cli.robot_options import RobotCheck
from hsr8.files import atomic
from hsr8.robots.loaded import load_robot
from hsr8.trials.robot_check import JointUse, WalkResult, check_robot, reasons

FAILED = 1
SHOWN = 12  # joints in the table; --json has all of them


def main(options: RobotCheck) -> int:
    """Print the results; 0 where the robot stands and walks, else 1."""
    robot = load_robot(options.robot)

    def report(result: WalkResult) -> None:
        if not options.quiet:
            print(f"{result.direction:<12}{_outcome(result)}", file=sys.stderr, flush=True)

    walks, joints = check_robot(robot, report)
    failures = reasons(robot, walks, joints)
    if options.json:
        result = {"robot": robot.name, "passed": not failures, "reasons": failures}
        lists = {"walks": list(map(asdict, walks)), "joints": list(map(asdict, joints))}
        print(atomic.dumps({**result, **lists}))
    elif not options.quiet:
        _show(robot.name, walks, joints)
        print("\n".join(failures) if failures else f"{robot.name} stands and walks")
    return FAILED if failures else 0


def _outcome(result: WalkResult) -> str:
    return "fell" if result.fell else f"tilt {result.tilt:.1f} deg"


def _show(name: str, walks: Sequence[WalkResult], joints: Sequence[JointUse]) -> None:
    rows = [
        {
            "direction": walk.direction,
            "command": _command(walk),
            "fell": walk.fell,
            "velocity error": _percent(walk.error),
            "tilt_deg": walk.tilt,
            "drift_m": walk.drift,
        }
        for walk in walks
    ]
    uses = [{k: _percent(v) for k, v in asdict(joint).items()} for joint in joints[:SHOWN]]
    console = Console(highlight=False)
    console.print(tables.rows(rows, name))
    title = f"limits used: the first {len(uses)} of {len(joints)} joints"
    console.print(tables.rows(uses, title))


def _command(walk: WalkResult) -> str:
    if not walk.speed:
        return "-"
    unit = "rad/s" if walk.direction.startswith("turn") else "m/s"
    return f"{walk.speed:.3f} {unit}"


def _percent(value: object) -> object:
    return f"{value:.1%}" if isinstance(value, float) else value
