"""Roles of the parts of a robot: base, legs, soles, head, shoulders and camera."""

from dataclasses import dataclass

Leg = tuple[str, str, str, str, str, str]


@dataclass(frozen=True, slots=True)
class Roles:
    """Parts of a robot by name in its MuJoCo model.

    Attributes:
        base: body with the free joint.
        feet: bodies of the left and the right foot.
        legs: six hinge joints of the left and the right leg, hip first.
        head: pan and tilt joint, if the robot has a movable head.
        shoulders: left and right shoulder pitch joint, if it has arms.
        trunk: body that carries the shoulders or the head; else the base.
    """

    base: str
    feet: tuple[str, str]
    legs: tuple[Leg, Leg]
    head: tuple[str, str] | None
    shoulders: tuple[str, str] | None
    trunk: str
