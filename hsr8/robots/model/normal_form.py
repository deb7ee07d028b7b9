"""Normal form of a robot: the parts that the simulator needs in its MuJoCo model.

The joints, masses and names of the file remain. Added are a site below each ankle, force pads under
the soles, an IMU, a camera with its site, and one box per sole; servos are added by rule where the
description asks for it. Lights, keyframes, sensors and the floor of the file are removed.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import radians

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.file.description import CameraMount, RobotDescription
from hsr8.robots.model.ignored import dropped_options
from hsr8.robots.model.servos import physics_step
from hsr8.robots.model.tree import Parts
from hsr8.robots.parts.roles import Roles, pose_of
from hsr8.robots.parts.skeleton import Posed, quaternion_of
from hsr8.robots.parts.soles import Rectangle
from hsr8.robots.scale import DEFAULT_FOV_DEG
from walking.model import Sole

Array = NDArray[np.float64]

FEET = ("hsr8/l_foot", "hsr8/r_foot")
SOLES = ("hsr8/l_sole", "hsr8/r_sole")
CAMERA_SITE, IMU = "hsr8/camera", "hsr8/imu"
ACCELEROMETER = "hsr8/accelerometer"
HEAD_CAMERA = "egocentric"
PADS = (("fl", 1, 1), ("fr", 1, -1), ("bl", -1, 1), ("br", -1, -1))
THICKNESS = 0.025  # half height of a sole box, of the height of base or hips above it [1]
EDGE = 0.001  # by which a force pad extends beyond the sole, where contacts act [m]
COLLISION_GROUP = 3
UPPER, MIDDLE = 0.9, 0.5  # height of a camera on the trunk, and on the head [1]
SKY = 8.0  # of the image of a fixed camera above the horizon, where beacons are [deg]
# Bits of contacts: 1 floor and soles, 2 obstacles hit the robot, the rest as in the file.
SOLE_BIT, BODY_BIT, SHIFT = 1, 2, 2
CONTACT = {
    "condim": 4,
    "friction": [0.8, 0.01, 0.001],
    "solref": [0.01, 1.0],
    "solimp": [0.9, 0.95, 0.001, 0.5, 2.0],
}


@dataclass(frozen=True, slots=True, eq=False)
class NormalForm:
    """Robot in normal form.

    Attributes:
        spec: MuJoCo model.
        parts: names of the added parts.
        notes: derived facts, a line each.
    """

    spec: mujoco.MjSpec
    parts: Parts
    notes: tuple[str, ...]


def pad(side: int, name: str) -> str:
    """Return the name of a force pad: its site and its sensor."""
    return f"hsr8/{'lr'[side]}_pad_{name}"


def normalise(
    spec: mujoco.MjSpec,
    zero: Posed,
    roles: Roles,
    soles: tuple[Rectangle, Rectangle],
    *,
    description: RobotDescription,
) -> NormalForm:
    """Bring a robot into normal form.

    Args:
        spec: specification, changed in place.
        zero: the robot in the zero posture, compiled from `spec`.
        roles: roles of the robot's parts.
        soles: soles of both feet.
        description: description of the robot.
    """
    notes = list(dropped_options(spec))
    before = float(spec.option.timestep)
    spec.option.timestep = physics_step(before)
    if abs(spec.option.timestep - before) > 1e-9:
        notes.append(f"physics step {1e3 * before:g} ms -> {1e3 * spec.option.timestep:g} ms")
    camera, note = _camera_pose(zero, roles, description)
    notes.append(note)
    _fix_masses(spec, zero.model)
    _strip(spec, zero.model, roles)
    _free_setpoints(spec)
    if not any(g.contype or g.conaffinity for g in spec.geoms):
        for geom in spec.geoms:
            geom.conaffinity = BODY_BIT if geom.group == COLLISION_GROUP else 0
    _set_contacts(spec)
    sole, replaced = Sole(0.0, 0.0, 0.0), _contact_shapes(spec, roles)
    if replaced:
        notes.append(f"contact shapes of the feet replaced by a box each: {replaced} shapes")
    for side in range(2):
        sole = _add_sole(spec, zero, roles, side, soles[side])
    spec.body(roles.base).add_site(name=IMU)
    kinds = mujoco.mjtSensor, mujoco.mjtObj
    spec.add_sensor(
        name=ACCELEROMETER,
        type=kinds[0].mjSENS_ACCELEROMETER,
        objtype=kinds[1].mjOBJ_SITE,
        objname=IMU,
    )
    _add_camera(spec, zero, camera)
    for link in reversed(spec.bodies[1:]):
        if not (link.joints or link.mass or link.name == roles.base):
            link.to_frame()  # a frame of the file, which costs time in every physics step
    return NormalForm(spec, Parts(FEET, sole, CAMERA_SITE), tuple(notes))


def _contact_shapes(spec: mujoco.MjSpec, roles: Roles) -> int:
    """Return the number of colliding shapes of the feet."""
    geoms = [geom for foot in roles.feet for geom in _shapes(spec.body(foot))]
    return sum(bool(geom.contype or geom.conaffinity) for geom in geoms)


def _shapes(body: mujoco.MjsBody) -> Iterator[mujoco.MjsGeom]:
    """Yield the shapes of a body and of those fixed to it."""
    yield from body.geoms
    for child in body.bodies:
        if not child.joints:
            yield from _shapes(child)


def _fix_masses(spec: mujoco.MjSpec, model: mujoco.MjModel) -> None:
    """State the inertia of every body, so that shapes can be added and removed."""
    for body in spec.bodies[1:]:
        compiled = model.body(body.name).id
        if model.body_mass[compiled] <= 0.0:
            continue
        body.explicitinertial = True
        body.mass = float(model.body_mass[compiled])
        body.ipos, body.iquat = model.body_ipos[compiled], model.body_iquat[compiled]
        body.ialt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT
        body.inertia = model.body_inertia[compiled]
        body.fullinertia = np.full(6, np.nan)
    for geom in spec.geoms:
        geom.mass = 0.0


def _strip(spec: mujoco.MjSpec, model: mujoco.MjModel, roles: Roles) -> None:
    """Remove what belongs to the world or to other tasks."""
    for parts in (spec.keys, spec.sensors, spec.lights):
        for part in list(parts):
            spec.delete(part)
    for geom in list(spec.worldbody.geoms):
        spec.delete(geom)
    root = model.body(roles.base).rootid[0]
    for body in list(spec.worldbody.bodies):
        if model.body(body.name).id != root:
            spec.delete(body)
    shapes = {geom.name for geom in spec.geoms}
    for contact in list(spec.pairs):
        if not {contact.geomname1, contact.geomname2} <= shapes:
            spec.delete(contact)
    for camera in list(spec.cameras):
        if camera.name == HEAD_CAMERA:
            spec.delete(camera)


def _free_setpoints(spec: mujoco.MjSpec) -> None:
    """Let setpoints pass the joint range, which walking keeps itself."""
    for servo in spec.actuators:
        servo.ctrllimited = mujoco.mjtLimited.mjLIMITED_FALSE
        servo.inheritrange = 0.0


def _set_contacts(spec: mujoco.MjSpec) -> None:
    """Let every colliding shape hit obstacles and floor, and keep the file's self-collisions."""
    for geom in spec.geoms:
        if geom.contype or geom.conaffinity:
            geom.contype = geom.contype << SHIFT
            geom.conaffinity = (geom.conaffinity << SHIFT) | BODY_BIT


def _add_sole(spec: mujoco.MjSpec, zero: Posed, roles: Roles, side: int, edges: Rectangle) -> Sole:
    """Add foot site, sole box and force pads; return the sole in the foot frame."""
    model, data = zero.model, zero.data
    body, at = spec.body(roles.feet[side]), model.body(roles.feet[side]).id
    rotation, position = data.xmat[at].reshape(3, 3), data.xpos[at]
    quaternion = quaternion_of(rotation.T)
    ankle = max(roles.legs[side][4:], key=lambda name: abs(data.xaxis[model.joint(name).id][1]))
    x = float(data.xanchor[model.joint(ankle).id][0])
    y = 0.5 * (edges.left + edges.right)
    half_length, half_width = 0.5 * (edges.front - edges.back), 0.5 * (edges.left - edges.right)
    centre = 0.5 * (edges.front + edges.back)
    hips = float(data.xanchor[model.joint(roles.legs[side][0]).id][2])
    thick = THICKNESS * (max(0.0, hips) - edges.height)

    def local(px: float, py: float, pz: float) -> Array:
        point: Array = rotation.T @ (np.array([px, py, pz]) - position)
        return point

    body.add_site(name=FEET[side], pos=local(x, y, edges.height), quat=quaternion)
    contype, conaffinity = _absorb_shapes(body)
    body.add_geom(
        name=SOLES[side],
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=local(centre, y, edges.height + thick),
        quat=quaternion,
        size=[half_length, half_width, thick],
        contype=contype | SOLE_BIT,
        conaffinity=conaffinity | SOLE_BIT,
        group=COLLISION_GROUP,
        mass=0.0,
        **CONTACT,
    )
    for name, ahead, left in PADS:
        px = centre + ahead * (0.5 * half_length + 0.5 * EDGE)
        py = y + left * (0.5 * half_width + 0.5 * EDGE)
        body.add_site(
            name=pad(side, name),
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=local(px, py, edges.height),
            quat=quaternion,
            size=[0.5 * half_length + 0.5 * EDGE, 0.5 * half_width + 0.5 * EDGE, thick],
            group=5,
        )
        spec.add_sensor(
            name=pad(side, name),
            type=mujoco.mjtSensor.mjSENS_TOUCH,
            objtype=mujoco.mjtObj.mjOBJ_SITE,
            objname=pad(side, name),
        )
    return Sole(centre - x, half_length, half_width)


def _absorb_shapes(body: mujoco.MjsBody) -> tuple[int, int]:
    """Return the self-collision bits of a foot's shapes, which its sole box takes over."""
    contype = conaffinity = 0
    for geom in _shapes(body):
        if geom.contype or geom.conaffinity:
            contype |= geom.contype
            conaffinity |= geom.conaffinity & ~BODY_BIT
            # Only the box meets the floor and the other foot.
            geom.contype = geom.conaffinity = 0
    return contype, conaffinity


def _camera_pose(
    zero: Posed, roles: Roles, description: RobotDescription
) -> tuple[tuple[str, Array, Array], str]:
    """Return body, position and rotation (right, down, forward) of the camera, and a note."""
    model, data = zero.model, zero.data
    stated = description.camera
    if isinstance(stated, str):
        camera = model.cam(stated).id
        body = model.body(int(model.cam_bodyid[camera])).name
        rotation = data.cam_xmat[camera].reshape(3, 3) * (1.0, -1.0, -1.0)
        width, height = model.cam_resolution[camera].tolist()
        size = f", its resolution of {width} x {height} left out: the scenario states it"
        note = f"camera {stated!r} on {body!r}{size if width > 1 else ''}"
        return (body, data.cam_xpos[camera].copy(), rotation), note
    mount = stated or _default_mount(zero, roles)
    tilt_deg = mount.tilt_deg
    if tilt_deg is None:
        tilt_deg = 0.0 if roles.head is not None else fixed_tilt(description.vertical_fov_deg)
    tilt = radians(tilt_deg)
    forward = np.array([np.cos(tilt), 0.0, np.sin(tilt)])
    right = np.array([0.0, -1.0, 0.0])
    rotation = np.column_stack([right, np.cross(forward, right), forward])
    position = pose_of(zero, mount.body)[1] + mount.position
    note = f"camera on {mount.body!r}, {position[2]:.2f} m above the base, tilt {tilt_deg:g} deg"
    return (mount.body, position, rotation), note


def _default_mount(zero: Posed, roles: Roles) -> CameraMount:
    """Return a mount on the front of the head, or of the upper trunk."""
    model, data = zero.model, zero.data
    if roles.head is not None:
        body = max(int(model.joint(name).bodyid[0]) for name in roles.head)  # the outer one
        height = MIDDLE
    else:
        body, height = model.body(roles.trunk).id, UPPER
    low, high = _extent(zero, body)
    origin = data.xpos[body]
    x, z = high[0], low[2] + height * (high[2] - low[2])
    position = (float(x - origin[0]), float(-origin[1]), float(z - origin[2]))
    return CameraMount(body=model.body(body).name, position=position)


def fixed_tilt(vertical_fov_deg: float | None) -> float:
    """Return the tilt of a camera without a neck, which shows the floor and the beacons [deg].

    Args:
        vertical_fov_deg: vertical field of view; that of the default camera if None [deg].
    """
    return round(SKY - 0.5 * (vertical_fov_deg or DEFAULT_FOV_DEG), 2)


def _extent(zero: Posed, body: int) -> tuple[Array, Array]:
    """Return the lower and the upper corner of the shapes that move with a body (3,) [m]."""
    model, data = zero.model, zero.data
    low, high = data.xpos[body].copy(), data.xpos[body].copy()
    group = model.body_weldid[model.geom_bodyid] == model.body_weldid[body]
    for geom in np.flatnonzero(group).tolist():
        centre, rotation, sides = zero.box(geom)
        half = np.abs(rotation) @ sides
        low, high = np.minimum(low, centre - half), np.maximum(high, centre + half)
    return low, high


def _add_camera(spec: mujoco.MjSpec, zero: Posed, pose: tuple[str, Array, Array]) -> None:
    """Add the camera and its site."""
    data, (body, position, rotation) = zero.data, pose
    at = zero.model.body(body).id
    frame = data.xmat[at].reshape(3, 3)
    offset = frame.T @ (position - data.xpos[at])
    carrier = spec.body(body)
    carrier.add_site(name=CAMERA_SITE, pos=offset, quat=quaternion_of(frame.T @ rotation))
    looking = rotation * (1.0, -1.0, -1.0)  # MuJoCo cameras look along -z with y up
    carrier.add_camera(name=HEAD_CAMERA, pos=offset, quat=quaternion_of(frame.T @ looking))
