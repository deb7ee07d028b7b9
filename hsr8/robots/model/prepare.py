"""Preparation of a model file: one robot that is free to move, of bodies with possible inertias.

The same for MJCF and URDF: joints that no servo can move are held, a missing free joint is added,
links without mass or with impossible inertia are completed or reported.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.file.key_mistake import KeyMistake, require_name
from hsr8.robots.file.read import ModelFile
from hsr8.robots.model.ignored import drop_ignored
from hsr8.robots.model.inertia import complete_inertias
from hsr8.robots.parts.prepared import Prepared, moving_body
from hsr8.robots.parts.skeleton import LEG_JOINTS, BaseFrame, clip_to_range, quaternion_of

Array = NDArray[np.float64]

MAX_LISTED = 6  # joints in a note
FREE, HINGE = mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_HINGE
LIMITED, UNLIMITED = mujoco.mjtLimited.mjLIMITED_TRUE, mujoco.mjtLimited.mjLIMITED_FALSE
JOINT_TIE = mujoco.mjtEq.mjEQ_JOINT
CLOSING = (mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtEq.mjEQ_WELD)
TO_JOINT = (mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtTrn.mjTRN_JOINTINPARENT)
COUPLINGS = (JOINT_TIE, mujoco.mjtEq.mjEQ_TENDON)


def prepare(
    source: ModelFile,
    feet: tuple[str, str] | None,
    *,
    base: str | None = None,
    rigid: tuple[str, ...] = (),
    powered: frozenset[str] = frozenset(),
    posture: Mapping[str, float],
    repair_inertia: bool = False,
    hold_followers: bool = True,
) -> Prepared:
    """Prepare a model.

    Held are: joints that follow another one, slides and balls, those with an effort or a range of
    zero, those that move no mass, and those of `rigid`. Joints of the legs are held by `rigid`, a
    range of zero, or a lack of mass only; an effort of zero counts in legs with six others.

    Args:
        source: model file; its model is changed.
        feet: bodies or links; None where they are unknown.
        base: body or link; default: the last one that the legs have in common and that is fixed to
            the body with the free joint.
        rigid: joints to hold.
        powered: joints that an effort of zero does not hold.
        posture: angles of held joints [rad or m].
        repair_inertia: whether impossible inertias are replaced.
        hold_followers: whether joints that follow others are held where the feet are unknown.

    Raises:
        KeyMistake: a foot or the base is unknown.
        ModelError: the base cannot move, or a body has an impossible inertia.
    """
    spec = source.spec
    for key in list(spec.keys):  # they have coordinates of joints that are held or added
        spec.delete(key)
    _require_links(spec, feet, base)
    root, notes = _only_robot(spec, feet)
    notes += drop_ignored(spec)
    _reflect_rotors(spec)
    notes += _free(spec, root, source)
    paths = [] if feet is None else [_joints_above(spec, spec.body(foot)) for foot in feet]
    on_path = {name for path in paths for name in path}
    followers = _followers(spec)
    if feet is None and not hold_followers:
        on_path |= {*followers}
    on_path |= _tied_to(spec, on_path, followers)
    all_powered = frozenset(joint.name for joint in spec.joints) if feet is None else powered
    held = dict(_held(spec, rigid, all_powered, on_path, followers))
    if any(sum(name not in held for name in path) < LEG_JOINTS for path in paths):
        held = dict(_held(spec, rigid, powered | on_path, on_path, followers))
    angles = {name: _held_angle(spec, name, posture, followers) for name in held}
    for name, angle in angles.items():
        hold(spec, name, angle)
    _forget_zero_efforts(spec)
    notes += _held_notes(held)
    base = base or _common_link(spec, root, feet)
    if moving_body(spec.body(base), root) != root:
        raise KeyMistake(
            f"base: not fixed to the body with the free joint, got {base!r}; expected {root!r} or "
            "one fixed to it: leave the key out"
        )
    if base != root:
        notes.append(f"base: {base!r}, fixed to {root!r}")
    notes += complete_inertias(spec, root, str(source.file), repair=repair_inertia)
    above = {
        foot: tuple(name for name in path if name in held)
        for foot, path in zip(feet or (), paths, strict=True)
    }
    return Prepared(spec, root, base, held, above, tuple(notes))


def _require_links(spec: mujoco.MjSpec, feet: tuple[str, str] | None, base: str | None) -> None:
    """Require that the model has the feet and the base of a description."""
    bodies = [body.name for body in spec.bodies[1:]]
    for side, foot in zip(("left", "right"), feet or (), strict=False):
        require_name(f"feet: {side} foot", "body", foot, bodies)
    if base is not None:
        require_name("base", "body", base, bodies)


def _forget_zero_efforts(spec: mujoco.MjSpec) -> None:
    """Remove limits of zero from joints that move: their maximum torque is unknown."""
    for joint in spec.joints:
        if joint.actfrclimited == LIMITED and not np.any(joint.actfrcrange):
            joint.actfrclimited = UNLIMITED


def turn_base(spec: mujoco.MjSpec, root: str, base: BaseFrame) -> None:
    """Move the frame of the body with the free joint to that of the base.

    Args:
        spec: specification, changed in place.
        root: body with the free joint.
        base: frame of the base.
    """
    body = spec.body(root)
    turn = quaternion_of(base.rotation)
    parts = [*body.bodies, *body.geoms, *body.sites, *body.cameras, *body.lights, *body.frames]
    frame = body.add_frame(pos=-base.rotation @ base.origin, quat=turn)
    for part in parts:
        if part.frame is None:
            part.set_frame(frame)
    if body.explicitinertial:
        turned = np.empty(4)
        mujoco.mju_mulQuat(turned, turn, orientation(spec, body.iquat, body.ialt))
        body.ipos = base.rotation @ (np.asarray(body.ipos, float) - base.origin)
        body.iquat, body.ialt.type = turned, mujoco.mjtOrientation.mjORIENTATION_QUAT
    body.quat, body.alt.type = (1.0, 0.0, 0.0, 0.0), mujoco.mjtOrientation.mjORIENTATION_QUAT


def hold(spec: mujoco.MjSpec, name: str, angle: float) -> None:
    """Remove a joint and its actuators; its body keeps the place of an angle [rad or m]."""
    joint = spec.joint(name)
    body, degree = joint.parent, bool(spec.compiler.degree)
    quat = orientation(spec, body.quat, body.alt)
    axis, anchor = np.asarray(joint.axis, float), np.asarray(joint.pos, float)
    axis = axis / np.linalg.norm(axis)
    turn, shift = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)
    if joint.type == HINGE:
        ref = float(np.radians(joint.ref)) if degree else float(joint.ref)
        mujoco.mju_axisAngle2Quat(turn, axis, angle - ref)
        shift = anchor - _rotated(turn, anchor)
    elif joint.type == mujoco.mjtJoint.mjJNT_SLIDE:
        shift = axis * (angle - float(joint.ref))
    back = np.empty(4)
    mujoco.mju_negQuat(back, turn)
    for other in body.joints:  # joints of the same body that come first see it in the turned body
        if other.name == name:
            break
        other.axis = _rotated(back, np.asarray(other.axis, float))
        other.pos = _rotated(back, np.asarray(other.pos, float) - shift)
    body.pos = np.asarray(body.pos, float) + _rotated(quat, shift)
    product = np.empty(4)
    mujoco.mju_mulQuat(product, quat, turn)
    body.quat, body.alt.type = product, mujoco.mjtOrientation.mjORIENTATION_QUAT
    for part in (*_referring(spec, name), joint):
        spec.delete(part)


def orientation(spec: mujoco.MjSpec, quaternion: Array, other: Any) -> Array:
    """Return a stated orientation as a unit quaternion (4,).

    Args:
        spec: specification, whose compiler has the unit of angles.
        quaternion: orientation, unless another form is stated (4,).
        other: orientation in another form.
    """
    if other.type == mujoco.mjtOrientation.mjORIENTATION_QUAT:
        quat = np.array(quaternion, float)
        normalised: Array = quat / np.linalg.norm(quat)
        return normalised
    return np.array(
        mujoco.MjSpec.resolve_orientation(
            degree=bool(spec.compiler.degree),
            sequence=spec.compiler.eulerseq,
            orientation=other,
        )
    )


def _referring(spec: mujoco.MjSpec, joint: str) -> list[Any]:
    """Return the elements that refer to a joint, which it takes along."""
    over = [t for t in spec.tendons if any(_wraps(wrap, joint) for wrap in t.path)]
    names = {joint, *(tendon.name for tendon in over)}
    servos = [servo for servo in spec.actuators if servo.target in names]
    ties = [
        tie for tie in spec.equalities if tie.type in COUPLINGS and {tie.name1, tie.name2} & names
    ]
    sensed = names | {servo.name for servo in servos}
    sensors = [sensor for sensor in spec.sensors if sensor.objname in sensed]
    return [*sensors, *ties, *servos, *over]


def _wraps(wrap: mujoco.MjsWrap, joint: str) -> bool:
    return bool(wrap.type == mujoco.mjtWrap.mjWRAP_JOINT and wrap.target.name == joint)


def _reflect_rotors(spec: mujoco.MjSpec) -> None:
    """Move armature and damping of actuators to their joints, which MuJoCo adds up."""
    for actuator in spec.actuators:
        joint = spec.joint(actuator.target) if actuator.trntype in TO_JOINT else None
        if joint is not None:
            squared = float(actuator.gear[0]) ** 2
            joint.armature += squared * actuator.armature
            joint.damping[0] += squared * actuator.damping[0]
            actuator.armature, actuator.damping[0] = 0.0, 0.0


def _only_robot(spec: mujoco.MjSpec, feet: tuple[str, str] | None) -> tuple[str, list[str]]:
    """Remove the other bodies of a scene; return the body that carries the robot, and a note.

    It is that of the left foot, else the one with most joints.
    """
    tops = list(spec.worldbody.bodies)
    root = max(tops, key=lambda body: len(body.find_all("joint")))
    if feet is not None:
        root = _path_up(spec, spec.body(feet[0]))[-1]
    others = [body for body in tops if body.name != root.name]
    shown = [repr(b.name) for b in others if b.find_all("joint") or b.find_all("geom")]
    if any(body.find_all("joint") for body in others):
        for sensor in list(spec.sensors):
            spec.delete(sensor)
    for body in others:
        spec.delete(body)
    note = f"{len(shown)} other bodies of the scene left out: {', '.join(shown[:MAX_LISTED])}"
    return root.name, [note] if shown else []


def _free(spec: mujoco.MjSpec, root: str, source: ModelFile) -> list[str]:
    """Add a missing free joint to the body that carries the robot; return a note.

    Raises:
        ModelError: other joints fix the robot to the world.
    """
    body = spec.body(root)
    if any(joint.type == FREE for joint in body.joints):
        return []
    if body.joints:
        raise ModelError(
            f"{source.file}: base: body {root!r} has joint {body.joints[0].name!r} and no free "
            "joint, so the robot is fixed to the world; expected a free base: replace its joints "
            "by <freejoint/>"
        )
    body.add_freejoint(name=f"{root}_free")
    return [] if source.is_urdf else [f"base: free joint added to body {root!r}"]


def _common_link(spec: mujoco.MjSpec, root: str, feet: tuple[str, str] | None) -> str:
    """Return the last body that both legs have in common and that is fixed to the root."""
    if feet is None:
        return root
    paths = [_path_up(spec, spec.body(foot))[::-1] for foot in feet]
    base = root
    for one, other in zip(*paths, strict=False):
        if one.name != other.name or (one.joints and one.name != root):
            break
        base = one.name
    return base


def _joints_above(spec: mujoco.MjSpec, body: mujoco.MjsBody | None) -> list[str]:
    """Return the joints from the robot's root down to a body, but for the free one."""
    bodies = reversed(_path_up(spec, body))
    return [joint.name for body in bodies for joint in body.joints if joint.type != FREE]


def _path_up(spec: mujoco.MjSpec, body: mujoco.MjsBody | None) -> list[mujoco.MjsBody]:
    """Return a body and those above it, without the world."""
    path = []
    while body is not None and body.name != spec.worldbody.name:
        path.append(body)
        body = body.parent
    return path


def _tied_to(
    spec: mujoco.MjSpec, legs: set[str], followers: Mapping[str, tuple[str, Array]]
) -> set[str]:
    """Return the joints of cranks and rods: those above closed chains, or coupled to the legs."""
    tied = {name for name, (leader, _) in followers.items() if leader in legs}
    for tie in spec.equalities:
        if tie.type in CLOSING and tie.active:
            for name in (tie.name1, tie.name2):
                part = spec.site(name) if tie.objtype == mujoco.mjtObj.mjOBJ_SITE else None
                body = spec.body(name) if part is None else part.parent
                tied |= {*_joints_above(spec, body)}
    return tied


def _followers(spec: mujoco.MjSpec) -> dict[str, tuple[str, Array]]:
    """Return leader (may be empty) and polynomial of each joint that follows another one."""
    ties = [tie for tie in spec.equalities if tie.type == JOINT_TIE and tie.active]
    return {tie.name1: (tie.name2, np.array(tie.data[:5])) for tie in ties}


def _held(
    spec: mujoco.MjSpec,
    rigid: tuple[str, ...],
    powered: frozenset[str],
    on_path: set[str],
    followers: Mapping[str, tuple[str, Array]],
) -> Iterator[tuple[str, str]]:
    """Yield every joint that is held, with the reason."""
    for joint in spec.joints:
        name = joint.name
        if joint.type == FREE:
            continue
        if name in rigid:
            yield name, "stated rigid"
        elif name in followers and name not in on_path:
            yield name, "follows a joint"
        elif joint.type != HINGE and name not in on_path:
            ball = joint.type == mujoco.mjtJoint.mjJNT_BALL
            yield name, "ball" if ball else "prismatic"
        elif joint.limited == LIMITED and joint.range[0] == joint.range[1]:
            yield name, "range of zero"
        elif (
            joint.actfrclimited == LIMITED and not np.any(joint.actfrcrange) and name not in powered
        ):
            yield name, "zero effort"
        elif not _may_move_mass(spec, joint.parent):
            yield name, "moves no mass"


def _may_move_mass(spec: mujoco.MjSpec, body: mujoco.MjsBody) -> bool:
    """Return whether a body or one below it may have a mass."""
    inferred = spec.compiler.inertiafromgeom != mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    own = body.mass > 0.0 if body.explicitinertial else inferred and bool(body.geoms)
    return own or any(_may_move_mass(spec, child) for child in body.bodies)


def _held_angle(
    spec: mujoco.MjSpec,
    name: str,
    posture: Mapping[str, float],
    followers: Mapping[str, tuple[str, Array]],
    depth: int = 0,
) -> float:
    """Return the angle of a held joint: of the posture, else by its leader, else near zero."""
    if name in posture:
        return posture[name]
    angle = 0.0
    if name in followers and depth < len(followers):
        leader, polynomial = followers[name]
        led = _held_angle(spec, leader, posture, followers, depth + 1) if leader else 0.0
        angle = float(np.polynomial.Polynomial(polynomial)(led))
    joint = spec.joint(name)
    lower, upper = joint.range
    if joint.limited == UNLIMITED or lower == upper == 0.0:
        return angle
    if joint.type == HINGE and spec.compiler.degree:
        lower, upper = np.radians([lower, upper]).tolist()
    return clip_to_range(angle, float(lower), float(upper))


def _held_notes(held: Mapping[str, str]) -> Iterator[str]:
    for reason in dict.fromkeys(held.values()):
        names = [name for name, its in held.items() if its == reason]
        more = " ..." if len(names) > MAX_LISTED else ""
        yield f"{len(names)} joints held ({reason}): {', '.join(names[:MAX_LISTED])}{more}"


def _rotated(quaternion: Array, vector: Array) -> Array:
    rotated = np.empty(3)
    mujoco.mju_rotVecQuat(rotated, vector, quaternion)
    return rotated
