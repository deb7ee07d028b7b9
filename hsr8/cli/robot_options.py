"""Commands about robots and their options; no heavy import, so that ``--help`` is fast."""

from dataclasses import dataclass
from typing import Annotated

from tyro.conf import Positional, arg, subcommand

from hsr8.cli.option_types import File, Json, Quiet, RobotName


@dataclass(frozen=True)
class RobotList:
    """List the shipped robots, and how to get the models that are missing."""

    json: Json = False


@dataclass(frozen=True)
class RobotInspect:
    """Guess the roles of a robot's parts and show the robot that results."""

    file: Positional[
        Annotated[str, arg(metavar="FILE", help="MJCF or URDF file, or a robot (name or file)")]
    ]
    write: File = None
    """Description to write, a new .toml file."""
    image: File = None
    """Draw the robot in its ready posture as a PNG."""
    json: Json = False


@dataclass(frozen=True)
class RobotCheck:
    """Let a robot stand and walk in every direction, and compare its joints with their limits."""

    robot: RobotName
    json: Json = False
    quiet: Quiet = False


@dataclass(frozen=True)
class RobotCalibrate:
    """Measure a robot in simulation and write the results into its description."""

    robot: RobotName
    out: File = None
    """Description to write instead, a new .toml file."""
    json: Json = False
    quiet: Quiet = False


@dataclass(frozen=True)
class Robot:
    """Robots: list them, inspect a model file, check and calibrate a robot."""

    action: (
        Annotated[RobotList, subcommand("list")]
        | Annotated[RobotInspect, subcommand("inspect")]
        | Annotated[RobotCheck, subcommand("check")]
        | Annotated[RobotCalibrate, subcommand("calibrate")]
    )


RobotAction = RobotList | RobotInspect | RobotCheck | RobotCalibrate
