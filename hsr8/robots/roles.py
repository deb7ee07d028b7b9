"""Roles of the parts of a robot: base, legs, soles, head, shoulders and camera."""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco

from hsr8.errors import ModelError
from hsr8.robots.description import CameraMount, RobotDescription
from hsr8.robots.key_mistake import KeyMistake, require_name
from hsr8.robots.skeleton import FREE, HINGE

Leg = tuple[str, str, str, str, str, str]

LEG_JOINTS = 6


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


def find_roles(model: mujoco.MjModel, description: RobotDescription, source: str) -> Roles:
    """Return the roles that a description states or that follow from the kinematic tree.

    Args:
        model: compiled.
        description: of the robot; its joints are those of the model.
        source: model file, which begins the messages about it.

    Raises:
        KeyMistake: a name is unknown, or a leg lacks six hinge joints.
        ModelError: the base is not free.
    """
    tree = _Tree(model, description, source)
    tree.require_names()
    feet = description.feet
    base = tree.base(feet)
    left, right = (tree.leg(foot, base) for foot in feet)
    if common := [name for name in left if name in right]:
        left_own, right_own = (tuple(n for n in leg if n not in common) for leg in (left, right))
        own = left_own if len(left_own) < len(right_own) else right_own
        raise KeyMistake(
            f"feet: a leg has {_count(own)} that it does not have in common with the other leg, "
            f"got {', '.join(own) or 'none'}; expected {LEG_JOINTS} hinge joints per leg: three "
            "at the hip, a knee, two at the ankle"
        )
    head, shoulders = description.head, description.shoulders
    carried = [tree.joint_parent(name) for name in shoulders or head or ()]
    trunk = tree.common_ancestor(carried) if carried else tree.body(base)
    return Roles(
        base=base,
        feet=feet,
        legs=(left, right),
        head=head,
        shoulders=shoulders,
        trunk=model.body(trunk).name,
    )


class _Tree:
    """Names of a model, and paths between its bodies."""

    def __init__(self, model: mujoco.MjModel, description: RobotDescription, source: str) -> None:
        self._model, self._description, self._source = model, description, source
        self._bodies = {model.body(b).name: b for b in range(1, model.nbody)}
        self._joints = {model.joint(j).name: j for j in range(model.njnt)}

    def body(self, name: str) -> int:
        return self._bodies[name]

    def require_names(self) -> None:
        """Refuse names of bodies and cameras that the model lacks."""
        robot, bodies = self._description, list(self._bodies)
        for side, foot in zip(("left", "right"), robot.feet, strict=True):
            require_name(f"feet: {side} foot", "body", foot, bodies)
        if robot.base is not None:
            require_name("base", "body", robot.base, bodies)
        if isinstance(robot.camera, CameraMount):
            require_name("camera.body", "body", robot.camera.body, bodies)
        elif robot.camera is not None:
            cameras = [self._model.camera(i).name for i in range(self._model.ncam)]
            require_name("camera", "camera", robot.camera, cameras)

    def base(self, feet: tuple[str, str]) -> str:
        """Return the name of the body with the free joint above both feet."""
        free = [[b for b in self._path(self.body(foot)) if self._is_free(b)] for foot in feet]
        stated = self._description.base
        if not free[0] or not free[1]:
            top = self._path(self.body(feet[0]))[-1]
            fixed = stated or self._model.body(top).name
            raise ModelError(
                f"{self._source}: base: body {fixed!r} has no free joint, so the robot is fixed to "
                "the world; expected a free base: add <freejoint/> to that <body> of the model"
            )
        if free[0] != free[1]:
            raise KeyMistake("feet: belong to two robots; expected both feet below one base")
        name: str = self._model.body(free[0][0]).name
        if stated not in (None, name):
            raise KeyMistake(
                f"base: body {stated!r} has no free joint; expected {name!r}, which has one"
            )
        return name

    def leg(self, foot: str, base: str) -> Leg:
        """Return the last six hinge joints above a foot."""
        model, names = self._model, list[str]()
        for body in self._path(self.body(foot)):
            if body == self.body(base) or len(names) >= LEG_JOINTS:
                break
            first = int(model.body_jntadr[body])
            for j in reversed(range(first, first + int(model.body_jntnum[body]))):
                name = model.joint(j).name
                if model.jnt_type[j] != HINGE and len(names) < LEG_JOINTS:
                    raise KeyMistake(
                        f"feet: joint {name!r} between foot {foot!r} and base is a slide or ball "
                        f"joint; expected {LEG_JOINTS} hinge joints per leg"
                    )
                names.insert(0, name)
        if len(names) < LEG_JOINTS:
            raise KeyMistake(
                f"feet: the leg above foot {foot!r} has {_count(names)}, got "
                f"{', '.join(names) or 'none'}; expected {LEG_JOINTS} hinge joints per leg: three "
                "at the hip, a knee, two at the ankle"
            )
        hip, thigh, calf, shank, ankle, sole = names[-LEG_JOINTS:]
        return hip, thigh, calf, shank, ankle, sole

    def joint_parent(self, joint: str) -> int:
        """Return the body above that of a joint."""
        return int(self._model.body_parentid[self._model.jnt_bodyid[self._joints[joint]]])

    def common_ancestor(self, bodies: Sequence[int]) -> int:
        """Return the lowest body that carries all `bodies`."""
        first, *rest = ([*self._path(body), 0] for body in bodies)
        return next(body for body in first if all(body in path for path in rest))

    def _path(self, body: int) -> list[int]:
        """Return a body and those above it, without the world."""
        path = []
        while body > 0:
            path.append(body)
            body = int(self._model.body_parentid[body])
        return path

    def _is_free(self, body: int) -> bool:
        first, n = int(self._model.body_jntadr[body]), int(self._model.body_jntnum[body])
        return n > 0 and bool(self._model.jnt_type[first] == FREE)


def _count(joints: Sequence[str]) -> str:
    return f"{len(joints)} hinge joint{'s' if len(joints) != 1 else ''}"
