"""Loaded robot: its model in normal form, its kinematics, and its walking parameters."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.checks.refusals import check_roles
from hsr8.robots.file.description import MAX_FOV, MIN_FOV, TRUNK, RobotDescription, read_description
from hsr8.robots.file.files import package_folders, reading_models, stamp_of
from hsr8.robots.file.key_mistake import KeyMistake, at_least, joint_error, reading_keys
from hsr8.robots.file.locate import find_description, find_model, model_files
from hsr8.robots.file.read import ModelFile, compile_spec, drop_drawn_meshes, read_spec
from hsr8.robots.file.urdf import drop_invalid_meshes
from hsr8.robots.model.linkage import drive_serially
from hsr8.robots.model.normal_form import normalise
from hsr8.robots.model.posed_shapes import arm_spheres, exclude_neighbours, robot_radius
from hsr8.robots.model.prepare import LIMITED, TO_JOINT, prepare, turn_base
from hsr8.robots.model.servos import choose_servos
from hsr8.robots.model.tree import tree_of
from hsr8.robots.parts.posture import check_joint_names, completed_posture, stated_posture
from hsr8.robots.parts.prepared import Prepared, moving_body
from hsr8.robots.parts.roles import Roles, base_frame, base_note, find_roles, present
from hsr8.robots.parts.skeleton import HINGE, LEG_JOINTS, SAME, BaseFrame, Posed
from hsr8.robots.parts.soles import soles_of
from hsr8.robots.walk.rehearsal import within_joints
from hsr8.robots.walk.rules import fit, one_leg_load
from walking.body.robot_model import RobotModel
from walking.constants import parameters_for
from walking.parameters import HeadParameters, WalkingParameters

Array = NDArray[np.float64]

PRECISION = 1e-9  # of masses [kg] and places [m] in the normal form
HEAVY = 0.8  # torque on one leg that is worth a note, of its maximum [1]
STANDING = 1e-9  # maximum error of the legs in the ready posture [rad]
SLACK = 1e-6  # of joint limits [rad]
HEAD_SPEED = 0.8  # of the head joints, of their maximum [1]
HEAD_TORQUE = 0.5  # of a head joint that accelerates it; gravity and damping need the rest [1]


@dataclass(frozen=True, slots=True, eq=False)
class LoadedRobot:
    """Robot that the simulator can place in a world.

    Attributes:
        name: name of its description.
        file: file of the model.
        description: description of its parts.
        roles: roles of its parts.
        spec: MuJoCo model in normal form; copy it before a change.
        model: kinematics and dynamics, in the ready posture.
        parameters: parameters of walking, derived from the model.
        arms: centres (n, 3) [m] and radii (n,) [m] of spheres around each arm, in the robot frame.
        has_meshes: whether meshes show its shapes.
        radius: radius of the walking robot seen from above [m].
        held: angles of the joints that walking does not move [rad].
        height: height of the base above the floor in the ready posture [m].
        fov_deg: vertical field of view of its camera; None for that of the scenario [deg].
        notes: derived facts, a line each.
    """

    name: str
    file: Path
    description: RobotDescription
    roles: Roles
    spec: mujoco.MjSpec
    model: RobotModel
    parameters: WalkingParameters
    arms: list[tuple[Array, Array]]
    has_meshes: bool
    radius: float
    held: dict[str, float]
    height: float
    fov_deg: float | None
    notes: tuple[str, ...]

    def body_names(self) -> list[str]:
        """Return the names of all bodies with a mass."""
        return [body.name for body in self.spec.bodies[1:] if body.mass > 0.0]

    def body_name(self, name: str) -> str:
        """Return the name of a body; ``trunk`` means that of the roles, if no body has the name."""
        return self.roles.trunk if name == TRUNK and self.spec.body(name) is None else name


@dataclass(frozen=True, slots=True, eq=False)
class RawRobot:
    """Robot as its file has it, before the normal form.

    Attributes:
        source: model file, which begins the messages about it.
        prepared: model; copy its specification before a change.
        model: compiled model.
        posture: angles of the description, its SRDF file or keyframe [rad].
        speed: maximum speed of the joints that state one [rad/s].
        notes: derived facts, a line each.
    """

    source: Path
    prepared: Prepared
    model: mujoco.MjModel
    posture: Mapping[str, float]
    speed: Mapping[str, float]
    notes: tuple[str, ...]


def load_robot(name_or_file: str) -> LoadedRobot:
    """Return a robot by the name of a shipped description, or by its file.

    Raises:
        ModelError: a file is missing or wrong, or the robot cannot walk; the message names the
            element, the reason and the remedy.
    """
    file = find_description(name_or_file).resolve()
    return _loaded(file, stamp_of(model_files(file)))


@lru_cache(maxsize=8)
def _loaded(file: Path, _files: tuple[tuple[str, int, int], ...]) -> LoadedRobot:
    return build_robot(read_description(file), file)


def build_robot(
    description: RobotDescription, file: Path, raw: RawRobot | None = None
) -> LoadedRobot:
    """Return the robot of a description.

    Args:
        description: description of the robot.
        file: description, or the model of a guessed one; relative paths begin at its folder.
        raw: model of the robot, if it has been read.

    Raises:
        ModelError: as `load_robot`.
    """
    raw = raw or read_robot(description, file)
    with reading_keys(file):
        return _built(description, file, raw)


def read_robot(description: RobotDescription, file: Path) -> RawRobot:
    """Read the model of a description.

    Args:
        description: description of the robot.
        file: file of the description; relative paths begin at its folder.

    Raises:
        ModelError: a key is wrong, or the model file is missing or wrong.
    """
    model_file = find_model(description, file)
    with reading_keys(file):
        return _read(description, file.parent, model_file)


def _read(description: RobotDescription, folder: Path, model_file: Path) -> RawRobot:
    packages = package_folders(description.packages, folder)
    source = read_spec(model_file, packages)
    spec = source.spec
    if packages and not source.is_urdf:
        raise KeyMistake("packages: got an MJCF file, which has none; expected a URDF file")
    if source.is_urdf and description.servo == "own":
        raise KeyMistake(
            "servo: a URDF file has no servos, got 'own'; expected 'rule', the default"
        )
    joints = [j.name for j in spec.joints if j.type == HINGE or j.name in description.rigid]
    check_joint_names(description, joints)
    _set_ranges(spec, description.range)
    posture = stated_posture(description, folder, spec)
    prepared = prepare(
        source,
        description.feet,
        base=description.base,
        rigid=description.rigid,
        powered=frozenset(
            (*description.effort, *(description.head or ()), *(description.shoulders or ()))
        ),
        posture={**posture, **description.zero},
        repair_inertia=description.repair_inertia,
    )
    _set_efforts(spec, description.effort)
    feet = [moving_body(spec.body(foot), prepared.root) for foot in description.feet]
    light = [] if description.camera is None else feet
    model, mesh_notes = _compiled(source, light)
    notes = [*source.notes, *prepared.notes, *mesh_notes]
    frame = _frame(model, description, prepared)
    if not frame.is_body:
        notes += base_note(model, frame, prepared.base)
        turn_base(spec, prepared.root, frame)
        before, (model, _) = Posed.at(model, {}, base=frame), _compiled(source, light)
        _compare(before, Posed.at(model, {}), str(model_file))
    speed = {**source.speed, **description.speed}
    if description.linkage is not None:
        carried, linkage_notes = drive_serially(prepared, description, speed)
        speed = {**carried, **speed}
        notes += linkage_notes
        _set_efforts(spec, description.effort)
        model, _ = _compiled(source, light)
    return RawRobot(model_file, prepared, model, posture, speed, tuple(notes))


def _compiled(source: ModelFile, feet: list[str]) -> tuple[mujoco.MjModel, list[str]]:
    """Compile a model; return notes on the meshes that are left out, also of its specification.

    Args:
        source: model.
        feet: bodies whose drawn meshes are needed; all of the robot are if there are none.
    """
    light = source.spec.copy()  # a compiled specification is slow to change
    if feet:
        drop_drawn_meshes(light, feet)
    model, notes = compile_spec(source, light)
    if notes:
        drop_invalid_meshes(source.spec)
    return model, notes


def _frame(model: mujoco.MjModel, description: RobotDescription, prepared: Prepared) -> BaseFrame:
    """Return the frame of the base; that of its body where the roles are to be refused."""
    try:
        return base_frame(model, description, prepared)
    except KeyMistake:
        return SAME


def _set_ranges(spec: mujoco.MjSpec, ranges: Mapping[str, tuple[float, float]]) -> None:
    """Set the limits of joints [rad]."""
    for name, limits in ranges.items():
        joint = spec.joint(name)
        joint.range = np.degrees(limits) if spec.compiler.degree else limits
        joint.limited = LIMITED


def _set_efforts(spec: mujoco.MjSpec, efforts: Mapping[str, float]) -> None:
    """Set the maximum torque of joints, also of their actuators [N m]."""
    for name, effort in efforts.items():
        joint = spec.joint(name)
        if joint is None:
            continue  # held
        joint.actfrcrange, joint.actfrclimited = (-effort, effort), LIMITED
        for servo in [s for s in spec.actuators if s.target == name and s.trntype in TO_JOINT]:
            force = effort / abs(float(servo.gear[0]))
            servo.forcerange, servo.forcelimited = (-force, force), LIMITED
            if servo.biastype == mujoco.mjtBias.mjBIAS_NONE:
                servo.ctrllimited = mujoco.mjtLimited.mjLIMITED_FALSE


def _built(description: RobotDescription, file: Path, raw: RawRobot) -> LoadedRobot:
    source, model, prepared = str(raw.source), raw.model, raw.prepared
    spec = prepared.spec.copy()
    roles = find_roles(model, description, prepared)
    completed, notes = completed_posture(
        model, description, {**raw.posture, **description.posture}, roles
    )
    notes = [*raw.notes, *notes]
    description = description.model_copy(update={"posture": completed})
    ranges, mirror_notes = check_roles(model, roles, description, source)
    _set_ranges(spec, ranges)
    straight = present(model, description.zero)
    zero = Posed.at(model, straight)
    soles, sole_notes = soles_of(zero, roles, description)
    posture = {**completed, **straight}
    servo_notes = choose_servos(
        spec,
        zero,
        roles,
        description,
        posture=posture,
        speed=raw.speed,
        sole_height=soles[0].height,
    )
    with reading_models(source):
        normal = normalise(spec, zero, roles, soles, description=description)
        light = normal.spec.copy()
        drop_drawn_meshes(light, roles.feet)
        compiled = light.compile()
    _compare(zero, Posed.at(compiled, straight), source)
    tree = tree_of(compiled, roles, normal.parts, posture, raw.speed)
    robot = RobotModel(tree)
    parameters, walk_notes = _fitted(robot, description, source)
    driven = set(tree.names)
    held = {name: angle for name, angle in posture.items() if name not in driven}
    base = parameters.pattern.pelvis_height - robot.legs[0].hip[2]
    angles = dict(zip(tree.names, robot.ready.tolist(), strict=True))
    standing = Posed.at(compiled, {**held, **angles}, base)
    collision_notes = exclude_neighbours(normal.spec, standing, roles, source)
    parameters = replace(parameters, head=_head(standing, robot, description))
    return LoadedRobot(
        name=file.stem,
        file=raw.source,
        description=description,
        roles=roles,
        spec=normal.spec,
        model=robot,
        parameters=parameters,
        arms=arm_spheres(standing, roles, has_meshes=bool(normal.spec.meshes)),
        has_meshes=bool(normal.spec.meshes),
        radius=description.radius or robot_radius(standing),
        held=held,
        height=base,
        fov_deg=_fov_deg(model, description),
        notes=(
            *notes,
            *mirror_notes,
            *sole_notes,
            *servo_notes,
            *normal.notes,
            *collision_notes,
            *walk_notes,
        ),
    )


def _fov_deg(model: mujoco.MjModel, description: RobotDescription) -> float | None:
    """Return the field of view that is stated, else that of a named camera of the model [deg].

    Raises:
        KeyMistake: the simulator has no such lens.
    """
    name = description.camera
    if not isinstance(name, str) or description.vertical_fov_deg is not None:
        return description.vertical_fov_deg
    fov = float(model.cam_fovy[model.camera(name).id])
    if not MIN_FOV <= fov <= MAX_FOV:
        raise KeyMistake(
            f"camera: {name!r}: fovy, got {fov:g} deg; expected {MIN_FOV:g} to {MAX_FOV:g}: state "
            "vertical_fov_deg"
        )
    return fov


def _head(standing: Posed, robot: RobotModel, description: RobotDescription) -> HeadParameters:
    """Return the limits of the head: as HSR-VIII, as far as its joints allow."""
    usual, model, tree = HeadParameters(), standing.model, robot.tree
    if tree.head is None or description.tuned:
        return usual
    matrix, head = np.zeros((model.nv, model.nv)), list(tree.head)
    mujoco.mj_fullM(model, standing.data, matrix)
    dofs = [int(model.joint(tree.names[k]).dofadr[0]) for k in head]
    rate = HEAD_SPEED * float(tree.speed[head].min())
    acceleration = HEAD_TORQUE * float((tree.effort[head] / matrix[dofs, dofs]).min())
    return HeadParameters(
        max_rate=description.head_rate or min(usual.max_rate, rate),
        max_acceleration=description.head_acceleration
        or float(f"{min(usual.max_acceleration, acceleration):.3g}"),
    )


def _fitted(
    robot: RobotModel, description: RobotDescription, source: str
) -> tuple[WalkingParameters, list[str]]:
    """Return the walking parameters of a robot, and notes; set its ready posture.

    Raises:
        ModelError: the robot cannot stand.
    """
    scaled = WalkingParameters() if description.tuned else parameters_for(robot)
    fitted = scaled if description.tuned else fit(robot, scaled)
    _stand(robot, fitted, description, source)
    strength = _strength(robot, fitted, description, source)
    if description.tuned:
        return fitted, strength
    calibration = description.calibration
    known = None if calibration is None else calibration.speed.model_dump()
    parameters, notes = within_joints(robot, fitted, known)
    hips, before = parameters.pattern.pelvis_height, scaled.pattern.pelvis_height
    if hips != before:
        notes.insert(0, f"hips {before:.3f} -> {hips:.3f} m high")
    if robot.stiffening > 1.0:
        notes.insert(0, f"leg servos stiffened {robot.stiffening:.2f} times by feedback")
    return parameters, notes + strength


def _stand(
    robot: RobotModel, parameters: WalkingParameters, description: RobotDescription, source: str
) -> None:
    """Set the ready posture and check that the legs reach it.

    Raises:
        ModelError: a foot is above the floor, or a joint outside its limits.
    """
    height = parameters.pattern.pelvis_height
    if robot.stand(height, parameters.gait.half_stance) > STANDING:
        raise KeyMistake(
            f"zero: the legs do not reach the floor in the ready posture, got hips at "
            f"{height:.3f} m; expected angles of straight legs, and soles below the ankles"
        )
    limits = zip(robot.names, robot.ready.tolist(), robot.tree.lower, robot.tree.upper, strict=True)
    for name, angle, lower, upper in list(limits)[: 2 * LEG_JOINTS]:
        if not lower - SLACK <= angle <= upper + SLACK:
            raise joint_error(
                name,
                "range",
                description,
                source,
                f"the ready posture is outside, got {angle:.3f} rad; expected {lower:.3g} to "
                f"{upper:.3g}",
            )


def _strength(
    robot: RobotModel, parameters: WalkingParameters, description: RobotDescription, source: str
) -> list[str]:
    """Check that each leg can carry the robot alone; return notes.

    Raises:
        ModelError: a joint is too weak.
    """
    loads = one_leg_load(robot, parameters.gait.half_stance, parameters.pattern.pelvis_height)
    worst = int(loads.argmax())
    load, name, effort = float(loads[worst]), robot.names[worst], robot.tree.effort[worst]
    if load > 1.0:
        raise joint_error(
            name,
            "effort",
            description,
            source,
            f"too weak to carry the robot on one leg, got a maximum torque of {effort:.3g} N m; "
            f"expected at least {at_least(load * effort)}: state effort, if that of the model is "
            "wrong",
        )
    return [f"{load:.0%} of the torque of {name} on one leg"] if load > HEAVY else []


def _compare(before: Posed, after: Posed, source: str) -> None:
    """Check that mass, centre of mass, inertia and joints are those of the file.

    Raises:
        ModelError: a quantity differs.
    """
    raw, normal = before.model, after.model
    root = int(raw.jnt_bodyid[0])
    _same(source, "mass [kg]", raw.body_subtreemass[root], normal.body_subtreemass[1])
    _same(source, "centre of mass [m]", before.data.subtree_com[root], after.data.subtree_com[1])
    inertias = (posed.data.cinert[:, :6].sum(axis=0) for posed in (before, after))
    _same(source, "inertia about the centre of mass [kg m²]", next(inertias), next(inertias))
    for joint in (raw.joint(j) for j in range(1, raw.njnt)):
        anchor = after.data.joint(joint.name).xanchor
        _same(source, f"place of joint {joint.name!r} [m]", before.data.xanchor[joint.id], anchor)


def _same(source: str, quantity: str, before: Array | float, after: Array | float) -> None:
    if not np.allclose(before, after, rtol=PRECISION, atol=PRECISION):
        raise ModelError(
            f"{source}: {quantity}: changed in the normal form, got {after}; expected {before}"
        )
