"""``hsr8 run``: checks before anything heavy is imported."""

import re
import sys
from dataclasses import replace
from math import inf

from hsr8.cli.command_line import command_words, option_tables, settings
from hsr8.cli.options import Run
from hsr8.errors import UsageError
from hsr8.files.text import shell_line
from hsr8.plugins.file import inspect_plugins
from hsr8.robots.file.description import read_description
from hsr8.robots.file.locate import find_description
from hsr8.robots.scale import DEFAULT_ROBOT
from hsr8.scenario.loader import load_scenario

MAX_DOMAIN = 232  # of ROS 2


def warn_of_rehearsed_robot(model: str) -> None:
    """Print that the noise of a robot is that of HSR-VIII, if the robot is not calibrated."""
    file = find_description(model)
    if file.suffix != ".toml":
        return
    description = read_description(file)
    if description.calibration is None and not description.tuned:
        print(
            f"warning: {model} is not calibrated: speeds are rehearsed, and the noise of odometry "
            f"and camera pose is that of {DEFAULT_ROBOT}; run `hsr8 robot calibrate {model}`",
            file=sys.stderr,
            flush=True,
        )


def main(options: Run) -> int:
    """Run the scenario and report."""
    scenario = load_scenario(
        options.scenario,
        settings(options),
        options.seed,
        options=option_tables(options),
        trust=options.trust or None,
    )
    inspect_plugins(scenario.plugin)
    _require_ros_options(options)
    if not options.quiet:
        print(f"{scenario.name}, seed {scenario.seed}", file=sys.stderr, flush=True)
        warn_of_rehearsed_robot(scenario.robot.model)
    from hsr8.cli.recorded_run import start  # noqa: PLC0415  takes seconds

    repeated = replace(options, seed=scenario.seed, view=None)
    if not options.ros_drive:  # topics without commands do not change a run
        repeated = replace(repeated, ros=False, ros_domain=0, ros_connect=None, ros_listen=None)
    return start(options, scenario, (shell_line(command_words(repeated)),))


def _require_ros_options(options: Run) -> None:
    """Require a valid pace and domain, and ``--ros`` with its further options."""
    if options.pace is not None and not 0.0 <= options.pace < inf:
        raise UsageError(f"--pace: got {options.pace:g}; expected a finite number of at least 0")
    if not 0 <= options.ros_domain <= MAX_DOMAIN:
        raise UsageError(f"--ros-domain: got {options.ros_domain}; expected 0 to {MAX_DOMAIN}")
    for option, endpoint in ("connect", options.ros_connect), ("listen", options.ros_listen):
        if endpoint is not None and not re.fullmatch(r"[a-z-]+/[^\s\"]+", endpoint):
            raise UsageError(f"--ros-{option}: got {endpoint!r}; expected such as tcp/HOST:7447")
    further = {
        "--ros-domain": options.ros_domain,
        "--ros-connect": options.ros_connect,
        "--ros-listen": options.ros_listen,
        "--ros-drive": options.ros_drive,
    }
    for option, value in further.items():
        if value and not options.ros:
            raise UsageError(f"{option}: got no --ros; expected both")
