"""Links of a robot from its compiled MuJoCo model, as URDF and tf have them."""

from dataclasses import dataclass, replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.model.normal_form import CAMERA_SITE, FEET, IMU

Array = NDArray[np.float64]

HINGE, SLIDE, FREE = (
    int(mujoco.mjtJoint.mjJNT_HINGE),
    int(mujoco.mjtJoint.mjJNT_SLIDE),
    int(mujoco.mjtJoint.mjJNT_FREE),
)
CAMERA, INERTIAL = "camera_optical_frame", "imu_sensor_frame"
SITES = {CAMERA_SITE: CAMERA, IMU: INERTIAL, FEET[0]: "l_sole_frame", FEET[1]: "r_sole_frame"}
"""Frames of the normal form, by site; the camera has x right, y down and z forward."""
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True, slots=True, eq=False)
class Link:
    """Link and the joint that carries it.

    The frame of the link is that of the joint, which is on its axis.

    Attributes:
        name: name of the link.
        parent: name of the link that carries it; empty for the base.
        joint: name of its joint.
        number: number of the joint in the model; -1 for a fixed joint.
        kind: fixed, revolute, continuous or prismatic.
        position: position in the parent at angle zero (3,) [m].
        orientation: quaternion w-x-y-z in the parent at angle zero (4,) [1].
        axis: axis in the link (3,) [1].
        body: number of the body whose masses and shapes the link has, in the same frame; -1 for
            none.
    """

    name: str
    parent: str
    joint: str
    number: int
    kind: str
    position: Array
    orientation: Array
    axis: Array
    body: int = -1


def links_of(model: mujoco.MjModel) -> list[Link]:
    """Return the links of a robot, parents first.

    Args:
        model: compiled robot in normal form, without a world.

    Raises:
        UsageError: a joint has a type that URDF lacks.
    """
    links: list[Link] = []
    for body in range(1, model.nbody):
        links += _links_of_body(model, body)
    for site in range(model.nsite):
        if (name := SITES.get(model.site(site).name)) is not None:
            parent = model.body(int(model.site_bodyid[site])).name
            links.append(_fixed(name, parent, model.site_pos[site], model.site_quat[site]))
    return links


def model_of(robot: LoadedRobot) -> mujoco.MjModel:
    """Return the compiled model of a robot without a world."""
    return robot.spec.copy().compile()


def _links_of_body(model: mujoco.MjModel, body: int) -> list[Link]:
    """Return the link of a body, after links without mass for further joints or offset axes."""
    name = model.body(body).name
    first = int(model.body_jntadr[body])
    joints = [
        j for j in range(first, first + int(model.body_jntnum[body])) if model.jnt_type[j] != FREE
    ]
    parent = model.body(int(model.body_parentid[body])).name
    position, orientation = model.body_pos[body].copy(), model.body_quat[body].copy()
    if model.body_parentid[body] == 0:
        return [replace(_fixed(name, "", np.zeros(3), IDENTITY), body=body)]
    links: list[Link] = []
    for j in joints:
        joint, anchor = model.joint(j).name, model.jnt_pos[j].copy()
        axis, zero = model.jnt_axis[j].copy(), float(model.qpos0[model.jnt_qposadr[j]])
        slides = model.jnt_type[j] == SLIDE
        if not slides and model.jnt_type[j] != HINGE:
            raise UsageError(f"joint {joint!r}: got a ball joint; expected hinges and slides")
        anchor = np.zeros(3) if slides else anchor
        origin = position + rotated(orientation, anchor - axis * zero if slides else anchor)
        turned = orientation if slides else product(orientation, about(axis, np.array(-zero)))
        limited = bool(model.jnt_limited[j])
        kind = "prismatic" if slides else "revolute" if limited else "continuous"
        links.append(Link(f"{joint}_axis", parent, joint, j, kind, origin, turned, axis))
        parent, position, orientation = f"{joint}_axis", -anchor, IDENTITY
    if links and not position.any():  # the axis of the last joint passes through the body's origin
        return [*links[:-1], replace(links[-1], name=name, body=body)]
    return [*links, replace(_fixed(name, parent, position, orientation), body=body)]


def _fixed(name: str, parent: str, position: Array, orientation: Array) -> Link:
    position, orientation = position.copy(), orientation.copy()
    return Link(name, parent, f"{name}_fixed", -1, "fixed", position, orientation, np.zeros(3))


def about(axis: Array, angle: Array) -> Array:
    """Return the quaternions of rotations about an axis (3,) by angles (...) [rad] (..., 4)."""
    half = 0.5 * np.asarray(angle)[..., None]
    return np.concatenate([np.cos(half), np.sin(half) * axis], axis=-1)


def product(a: Array, b: Array) -> Array:
    """Return the products of quaternions w-x-y-z (..., 4)."""
    a, b = np.broadcast_arrays(a, b)
    (w, x, y, z), (s, i, j, k) = np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0)
    parts = (
        w * s - x * i - y * j - z * k,
        w * i + x * s + y * k - z * j,
        w * j - x * k + y * s + z * i,
        w * k + x * j - y * i + z * s,
    )
    return np.stack(parts, axis=-1)


def rotated(quaternion: Array, vector: Array) -> Array:
    """Return vectors (..., 3) rotated by quaternions w-x-y-z (..., 4)."""
    w, axis = quaternion[..., :1], quaternion[..., 1:]
    turn = 2.0 * np.cross(axis, vector)
    result: Array = vector + w * turn + np.cross(axis, turn)
    return result


def inverse(quaternion: Array) -> Array:
    """Return the inverse of unit quaternions w-x-y-z (..., 4)."""
    result: Array = quaternion * (1.0, -1.0, -1.0, -1.0)
    return result
