"""Section ``[robot]``: body, initial pose and speed limits."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from annotated_types import Interval, Len, doc

from hsr8.scenario.section import Radius, Section
from hsr8.scenario.world import Start

NOMINAL_SPEED = 0.20
"""Maximum forward speed of HSR-VIII, by which the times of worlds scale [m/s]."""
SUFFIX = ".toml"  # of the file of a robot, which no name has

WalkingSpeed = Annotated[float, Interval(ge=0.01, le=5.0), "m/s"]


class SpeedEnvelope(Section):
    """Speed limits of navigation."""

    vx: Annotated[WalkingSpeed, doc("Maximum forward speed [m/s].")] = NOMINAL_SPEED
    vx_backward: Annotated[WalkingSpeed, doc("Maximum backward speed [m/s].")] = 0.10
    vy: Annotated[WalkingSpeed, doc("Maximum sideways speed [m/s].")] = 0.08
    wz: Annotated[float, Interval(ge=0.01, le=10.0), "rad/s", doc("Maximum turn rate [rad/s].")] = (
        0.8
    )
    acceleration: Annotated[
        float, Interval(ge=0.005, le=20.0), "m/s²", doc("Maximum acceleration [m/s²].")
    ] = 0.3


class Robot(Section):
    """Body, initial pose and speed limits."""

    model: Annotated[
        str,
        Len(1, 1000),
        doc(
            "Robot: a shipped name or the file of a description, next to the scenario or in the "
            "working folder."
        ),
    ] = "hsr8"
    body: Annotated[
        Literal["full", "kinematic"],
        doc("full: MuJoCo physics; kinematic: no dynamics, every footstep lands as planned."),
    ] = "full"
    radius: Annotated[
        Radius,
        doc("Radius of the walking robot, for worlds, their certificates and navigation [m]."),
    ] = 0.12
    start: Annotated[Start, doc("Initial pose.")] = Start()
    speed: Annotated[SpeedEnvelope, doc("Speed limits of navigation.")] = SpeedEnvelope()


def located(table: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return a scenario's tables with the absolute path of the robot's file, if it exists.

    Args:
        table: table with `robot.model` or without.
        folder: folder in which a relative path begins; else it begins in the working folder.
    """
    robot = table.get("robot")
    if not isinstance(robot, dict) or not str(robot.get("model")).endswith(SUFFIX):
        return dict(table)
    model = str(robot["model"])
    file = Path(os.path.expanduser(model))
    paths = (path.absolute() for path in (folder / file, file) if os.path.isfile(path))
    return {**table, "robot": {**robot, "model": str(next(paths, model))}}
