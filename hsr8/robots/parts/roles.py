"""Roles of the parts of a robot: base, legs, soles, head, shoulders and camera."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import acos, degrees

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.file.description import CameraMount, RobotDescription
from hsr8.robots.file.key_mistake import KeyMistake, require_name
from hsr8.robots.parts.prepared import Prepared
from hsr8.robots.parts.skeleton import HINGE, LEG_JOINTS, SAME, BaseFrame, Posed, path_up

Array = NDArray[np.float64]
Leg = tuple[str, str, str, str, str, str]

EXPECTED = f"{LEG_JOINTS} hinge joints per leg: three at the hip, a knee, two at the ankle"
MAX_LEFT_ANGLE, MAX_UP_ANGLE = 10.0, 20.0  # from the nearest axis of the base [deg]
MIN_STANCE = 1e-3  # distance of the feet, and height of the hips [m]


@dataclass(frozen=True, slots=True, eq=False)
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


def find_roles(model: mujoco.MjModel, description: RobotDescription, prepared: Prepared) -> Roles:
    """Return the roles that a description states or that follow from the kinematic tree.

    Args:
        model: model compiled from `prepared`.
        description: description of the robot.
        prepared: model, in which some links are parts of a body.

    Raises:
        KeyMistake: a name is unknown, a leg lacks six hinge joints, or the robot does not stand on
            its feet.
    """
    _require_camera(model, description)
    left, right = (_moving(model, foot) for foot in description.feet)
    legs = _leg(model, prepared, description.feet[0]), _leg(model, prepared, description.feet[1])
    if common := [name for name in legs[0] if name in legs[1]]:
        left_own, right_own = (tuple(n for n in leg if n not in common) for leg in legs)
        own = left_own if len(left_own) < len(right_own) else right_own
        raise KeyMistake(
            f"feet: a leg has {_count(own)} that it does not have in common with the other leg, "
            f"got {', '.join(own) or 'none'}; expected {EXPECTED}"
        )
    for key in ("head", "shoulders"):
        for name in getattr(description, key) or ():
            if name in prepared.held:
                raise KeyMistake(
                    f"{key}: joint {name!r} cannot move: {prepared.held[name]}; expected a driven "
                    "joint: leave the key out"
                )
    base_frame(model, description, prepared)  # the robot stands
    head, shoulders = description.head, description.shoulders
    carried = shoulders or head
    return Roles(
        base=prepared.root,
        feet=(left, right),
        legs=legs,
        head=head,
        shoulders=shoulders,
        trunk=_trunk(model, carried) if carried else prepared.root,
    )


def pose_of(posed: Posed, body: str) -> tuple[Array, Array]:
    """Return rotation (3, 3) and position (3,) [m] of a body."""
    at = posed.model.body(body).id
    return posed.data.xmat[at].reshape(3, 3), posed.data.xpos[at]


def _moving(model: mujoco.MjModel, body: str) -> str:
    """Return the body with joints that carries a body, or the body itself."""
    name: str = model.body(int(model.body_weldid[model.body(body).id])).name
    return name


def base_frame(
    model: mujoco.MjModel, description: RobotDescription, prepared: Prepared
) -> BaseFrame:
    """Return the frame of the base, whose axes are those of its link nearest to the robot's.

    Left is from the right to the left foot, up from the feet to the hips, at the angles `zero`.

    Args:
        model: model compiled from `prepared`.
        description: description of the robot.
        prepared: prepared model.

    Raises:
        KeyMistake: a leg lacks six hinge joints, or the robot does not stand with its feet side by
            side below the hips.
    """
    legs = [_leg(model, prepared, foot) for foot in description.feet]
    feet = [_moving(model, foot) for foot in description.feet]
    posed = Posed.at(model, present(model, description.zero))
    link, origin = pose_of(posed, prepared.base)
    hips, ankles = (
        [link.T @ posed.data.xanchor[model.joint(leg[end]).id] for leg in legs] for end in (0, -1)
    )
    across, upward = ankles[0] - ankles[1], sum(hips) - sum(ankles)
    if min(float(np.linalg.norm(across)), float(np.linalg.norm(upward))) < MIN_STANCE:
        raise KeyMistake(
            f"feet: at zero angles {feet[0]!r} and {feet[1]!r} are at one point or at the hips; "
            "expected straight legs side by side: state other angles as zero"
        )
    left = _axis(across, "from the right to the left foot", prepared.base, MAX_LEFT_ANGLE)
    up = _axis(upward, "from the feet to the hips", prepared.base, MAX_UP_ANGLE)
    forward = np.cross(left, up)
    if not forward.any():
        raise KeyMistake(
            "zero: the feet are not side by side below the hips; expected a robot that stands: "
            "state angles of straight legs as zero"
        )
    turn = np.array([forward, left, up])
    if (turn == np.eye(3)).all() and prepared.base == prepared.root:
        return SAME
    return BaseFrame(turn @ link.T, origin.copy())


def base_note(model: mujoco.MjModel, frame: BaseFrame, base: str) -> list[str]:
    """Return a note on the directions of the base, where they are not those of its link.

    Args:
        model: model before the turn.
        frame: frame of the base.
        base: link of the base.
    """
    turn = frame.rotation @ pose_of(Posed.at(model, {}), base)[0]
    if np.allclose(turn, np.eye(3)):
        return []
    names = (_axis_name(turn[row]) for row in (0, 2))
    return [f"base turned: forward is {next(names)} of {base!r}, up its {next(names)}"]


def present(model: mujoco.MjModel, angles: dict[str, float]) -> dict[str, float]:
    """Return the angles of the joints that a model has."""
    names = {model.joint(j).name for j in range(model.njnt)}
    return {name: angle for name, angle in angles.items() if name in names}


def _axis(vector: Array, meaning: str, base: str, max_angle: float) -> Array:
    """Return the axis of the base nearest to a vector (3,)."""
    k = int(np.abs(vector).argmax())
    axis = np.zeros(3)
    axis[k] = np.sign(vector[k])
    angle = degrees(acos(min(1.0, float(vector @ axis) / float(np.linalg.norm(vector)))))
    if angle > max_angle:
        direction = vector / np.linalg.norm(vector)
        raise KeyMistake(
            f"base: at zero angles the direction {meaning} is {angle:.0f} deg from the axes of "
            f"{base!r}, got ({', '.join(f'{v + 0.0:.2f}' for v in direction)}); expected at most "
            f"{max_angle:.0f} deg: turn its frame in the model, or state angles of straight legs "
            "as zero"
        )
    return axis


def _axis_name(axis: Array) -> str:
    k = int(np.abs(axis).argmax())
    return f"{'-' if axis[k] < 0.0 else ''}{'xyz'[k]}"


def _require_camera(model: mujoco.MjModel, description: RobotDescription) -> None:
    """Refuse the name of a camera, or of its body, that the model lacks."""
    if isinstance(description.camera, CameraMount):
        names = [model.body(b).name for b in range(1, model.nbody)]
        require_name("camera.body", "body", description.camera.body, names)
    elif description.camera is not None:
        cameras = [model.camera(i).name for i in range(model.ncam)]
        require_name("camera", "camera", description.camera, cameras)


def _leg(model: mujoco.MjModel, prepared: Prepared, foot: str) -> Leg:
    """Return the last six hinge joints above a foot."""
    names = list[str]()
    for above in path_up(model, model.body(foot).id):
        if model.body(above).name == prepared.root or len(names) >= LEG_JOINTS:
            break
        first = int(model.body_jntadr[above])
        for j in reversed(range(first, first + int(model.body_jntnum[above]))):
            name = model.joint(j).name
            if model.jnt_type[j] != HINGE and len(names) < LEG_JOINTS:
                raise KeyMistake(
                    f"feet: joint {name!r} between foot {foot!r} and base is a slide or ball "
                    f"joint; expected {EXPECTED}"
                )
            names.insert(0, name)
    if len(names) < LEG_JOINTS:
        held = prepared.held_above.get(foot, ())
        texts = [f"{name}: {prepared.held[name]}" for name in held]
        more = f" and {len(held)} that are held ({', '.join(texts)})" if held else ""
        raise KeyMistake(
            f"feet: the leg above foot {foot!r} has {_count(names)}{more}, got "
            f"{', '.join(names) or 'none'}; expected {EXPECTED}"
        )
    hip, thigh, calf, shank, ankle, sole = names[-LEG_JOINTS:]
    return hip, thigh, calf, shank, ankle, sole


def _trunk(model: mujoco.MjModel, joints: Sequence[str]) -> str:
    """Return the lowest body that carries the bodies of all `joints`."""
    bodies = (int(model.joint(name).bodyid[0]) for name in joints)
    first, *others = ([*path_up(model, body), 0][1:] for body in bodies)
    name: str = model.body(next(b for b in first if all(b in path for path in others))).name
    return name


def _count(joints: Sequence[str]) -> str:
    return f"{len(joints)} hinge joint{'s' if len(joints) != 1 else ''}"
