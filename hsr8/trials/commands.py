"""Commands of trials: random velocities and head targets, and the time scale of a robot."""

from collections.abc import Callable
from math import pi

import numpy as np

from hsr8.robots.loaded import LoadedRobot
from walking.command import HeadTarget, VelocityCommand
from walking.parameters import WalkingParameters

STOPS, CORNERS = 0.15, 0.15  # fractions of random commands at rest and at the corners
HEAD_INTERVAL = 0.4  # between head targets [s]


def time_scale(parameters: WalkingParameters) -> float:
    """Return the time of a robot's walk relative to that of HSR-VIII [1]."""
    return parameters.gait.footstep_time / WalkingParameters().gait.footstep_time


def random_commands(
    speed: dict[str, float],
    scale: float,
    seed: int,
    *,
    stops: float = STOPS,
    corners: float = CORNERS,
) -> Callable[[float], VelocityCommand]:
    """Return random commands within an envelope, by time.

    Args:
        speed: envelope.
        scale: scale of the time between changes, 0.5 to 2 s for HSR-VIII [1].
        seed: seed of the commands.
        stops: fraction of commands to stand [1].
        corners: fraction of commands with the maximum speed along every axis [1].
    """
    rng = np.random.default_rng([seed, 5])
    low = np.array([-speed["vx_backward"], -speed["vy"], -speed["wz"]])
    high = np.array([speed["vx"], speed["vy"], speed["wz"]])
    ends, commands = [0.0], []
    while ends[-1] < 3600.0:
        ends.append(ends[-1] + scale * float(rng.uniform(0.5, 2.0)))
        kind, drawn = float(rng.uniform()), rng.uniform(low, high)
        if kind < stops:
            drawn = np.zeros(3)
        elif kind < stops + corners:
            drawn = np.where(rng.uniform(size=3) < 0.5, low, high)
        commands.append(VelocityCommand(*drawn.tolist()))
    return lambda time: commands[int(np.searchsorted(ends, time, side="right")) - 1]


def random_head(robot: LoadedRobot, seed: int) -> Callable[[float], HeadTarget]:
    """Return random head targets within the range of the head, by time."""
    rng = np.random.default_rng([seed, 6])
    low, high = robot.model.neck.range().T
    low, high = np.maximum(low, (-0.5 * pi, -pi / 3.0)), np.minimum(high, (0.5 * pi, pi / 9.0))
    targets = [HeadTarget(*rng.uniform(low, np.maximum(low, high)).tolist()) for _ in range(9000)]
    return lambda time: targets[int(time / HEAD_INTERVAL)]
