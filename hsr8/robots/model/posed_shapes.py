"""Shapes of a robot in its ready posture: arms, extent, and parts that overlap.

The arms are spheres for the self mask of vision.
"""

from collections.abc import Sequence
from math import asin, atan2, hypot, pi, tan

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.model.normal_form import COLLISION_GROUP
from hsr8.robots.parts.roles import Roles
from hsr8.robots.parts.skeleton import Posed, is_below, path_up

Array = NDArray[np.float64]

CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
ROUND = (
    mujoco.mjtGeom.mjGEOM_SPHERE,
    mujoco.mjtGeom.mjGEOM_CAPSULE,
    mujoco.mjtGeom.mjGEOM_ELLIPSOID,
)
SWING = 0.12  # room for the motion of an arm, per distance from the shoulder [1]
BEARINGS = 72  # steps of the shadow [1]
TOUCHING = -5e-4  # distance of shapes that overlap [m]
NEIGHBOURS = 3  # joints between links whose shapes may overlap by the maker's choice
FAR = 100.0  # reach of the shadow of an arm that the camera sees above the horizon [m]


def arm_spheres(robot: Posed, roles: Roles, *, has_meshes: bool) -> list[tuple[Array, Array]]:
    """Return centres (n, 3) [m] and radii (n,) [m] of spheres around each arm.

    Args:
        robot: robot in the ready posture, on the floor.
        roles: roles of the robot's parts.
        has_meshes: whether meshes show its shapes.
    """
    model, data = robot.model, robot.data
    arms = []
    for shoulder in roles.shoulders or ():
        root = int(model.joint(shoulder).bodyid[0])
        geoms = [g for g in range(model.ngeom) if is_below(model, int(model.geom_bodyid[g]), root)]
        visible = [g for g in geoms if _seen(model, g, has_meshes=has_meshes)]
        spheres = [sphere for g in visible for sphere in _spheres(robot, g)]
        centres = np.array([centre for centre, _ in spheres]).reshape(-1, 3)
        away = np.linalg.norm(centres - data.xanchor[model.joint(shoulder).id], axis=1)
        arms.append((centres, np.array([radius for _, radius in spheres]) + SWING * away))
    return [arm for arm in arms if len(arm[1])]


def ground_shadow(arms: Sequence[tuple[Array, Array]], height: float) -> Array:
    """Return the distance from the camera up to which the arms hide the floor (BEARINGS,) [m].

    Args:
        arms: see `arm_spheres`; the camera is above their origin.
        height: height of the camera [m].
    """
    shadow = np.zeros(BEARINGS)
    bearings = np.arange(BEARINGS) * 2.0 * pi / BEARINGS
    for centre, radius in ((c, r) for arm in arms for c, r in zip(*arm, strict=True)):
        x, y, z = (centre - (0.0, 0.0, height)).tolist()
        away = hypot(x, y)
        elevation, half = atan2(z, away), asin(min(1.0, float(radius) / hypot(away, z)))
        if elevation - half >= 0.0:
            continue  # above the horizon
        edge = -(elevation + half)
        reach = FAR if FAR * tan(edge) <= height else height / tan(edge)
        off = np.abs((bearings - atan2(y, x) + pi) % (2.0 * pi) - pi)
        hides = off <= asin(min(1.0, float(radius) / away))
        shadow[hides] = np.maximum(shadow[hides], reach)
    return shadow


def _seen(model: mujoco.MjModel, geom: int, *, has_meshes: bool) -> bool:
    """Return whether the head camera sees a geom: of meshes it sees the colliding ones only."""
    solid = bool(model.geom_contype[geom] or model.geom_conaffinity[geom])
    if solid and has_meshes:
        return True
    mesh = model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH
    return bool(model.geom_group[geom] < COLLISION_GROUP) and not mesh


def _spheres(robot: Posed, geom: int) -> list[tuple[Array, float]]:
    """Return two spheres along the longest side of the box around a geom."""
    centre, rotation, half = robot.box(geom)
    longest = int(np.argmax(half))
    across = np.delete(half, longest)
    round_ = robot.model.geom_type[geom] in ROUND
    radius = float(across.max() if round_ else np.hypot(*across))
    reach = rotation[:, longest] * max(0.0, float(half[longest]) - radius)
    return [(centre - reach, radius), (centre + reach, radius)]


def robot_radius(robot: Posed) -> float:
    """Return the radius of the upright cylinder around a standing robot's colliding shapes [m].

    Args:
        robot: robot in the ready posture, the base above the origin.
    """
    model, radius = robot.model, 0.0
    for geom in range(model.ngeom):
        if model.geom_contype[geom] or model.geom_conaffinity[geom]:
            centre, rotation, half = robot.box(geom)
            corners = centre + (CORNERS * half) @ rotation.T
            radius = max(radius, float(np.hypot(corners[:, 0], corners[:, 1]).max()))
    return float(f"{radius:.3g}")


def robot_height(robot: Posed) -> float:
    """Return the height of a standing robot's highest shape above the floor [m].

    Args:
        robot: robot in the ready posture, on the floor.
    """
    model, data = robot.model, robot.data
    up = data.geom_xmat[:, 6:]  # the vertical in the axes of each geom
    tops = data.geom_xpos[:, 2] + np.sum(up * model.geom_aabb[:, :3], axis=1)
    tops += np.sum(np.abs(up) * model.geom_aabb[:, 3:], axis=1)
    return float(f"{tops.max(initial=0.0):.3g}")


class SelfCollision(ModelError):
    """Overlap of links in the ready posture."""


def exclude_neighbours(spec: mujoco.MjSpec, ready: Posed, roles: Roles, source: str) -> list[str]:
    """Exclude overlapping links close to each other from contact, and refuse other overlaps.

    Shapes of links around one joint overlap in many files. Arms in the trunk, or legs in each
    other, mean another posture.

    Args:
        spec: specification of the robot, changed in place.
        ready: robot in its ready posture, above the floor.
        roles: roles of its parts.
        source: model file, which begins the message.

    Returns:
        Notes, a line each.

    Raises:
        SelfCollision: links far from each other overlap.
    """
    model, notes = ready.model, []
    overlaps: dict[tuple[int, int], float] = {}
    for contact in ready.data.contact[: ready.data.ncon]:
        one, other = sorted(int(model.geom_bodyid[geom]) for geom in contact.geom)
        if contact.dist < TOUCHING:
            overlaps[one, other] = min(float(contact.dist), overlaps.get((one, other), 0.0))
    for (one, other), distance in overlaps.items():
        names = model.body(one).name, model.body(other).name
        joints = _joints_between(model, one, other)
        if len(joints) > NEIGHBOURS:
            raise SelfCollision(
                f"{source}: ready posture: {names[0]!r} and {names[1]!r} overlap by "
                f"{-1e3 * distance:.1f} mm; expected a posture without self-collision: "
                f"{_remedy(joints, roles)}add <exclude body1={names[0]!r} body2={names[1]!r}/> to "
                "<contact>"
            )
        spec.add_exclude(bodyname1=names[0], bodyname2=names[1])
        notes.append(f"overlapping neighbours {names[0]!r} and {names[1]!r} do not collide")
    return notes


def _remedy(joints: list[str], roles: Roles) -> str:
    """Return the advice to move some of the joints between two links, if a description can."""
    moving = {*roles.legs[0], *roles.legs[1], *(roles.head or ())}
    free = [joint for joint in joints if joint not in moving]
    return f"state other angles of {', '.join(free)} in posture, or " if free else ""


def _joints_between(model: mujoco.MjModel, one: int, other: int) -> list[str]:
    """Return the joints between two bodies."""
    apart = {*path_up(model, one)} ^ {*path_up(model, other)}
    return [model.joint(j).name for j in range(model.njnt) if model.jnt_bodyid[j] in apart]
