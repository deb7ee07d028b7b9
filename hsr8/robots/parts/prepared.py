"""Prepared model of a robot, in which all bodies of the file remain."""

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco


@dataclass(frozen=True, slots=True, eq=False)
class Prepared:
    """Prepared model.

    Attributes:
        spec: MuJoCo model.
        root: body with the free joint.
        base: body of the base: `root`, or one fixed to it.
        held: reason of each joint that is held.
        held_above: those above each foot.
        notes: derived facts, a line each.
    """

    spec: mujoco.MjSpec
    root: str
    base: str
    held: Mapping[str, str]
    held_above: Mapping[str, tuple[str, ...]]
    notes: tuple[str, ...]


def moving_body(body: mujoco.MjsBody, root: str) -> str:
    """Return the body with joints that carries a body: itself, or one that it is fixed to.

    Args:
        body: body of the robot.
        root: body with the free joint.
    """
    while body.name != root and not body.joints:
        body = body.parent
    name: str = body.name
    return name
