"""Loaded robot: its model in normal form, its kinematics, and its walking parameters."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.checks.comparison import require_same
from hsr8.robots.checks.refusals import check_roles
from hsr8.robots.file.description import MAX_FOV, MIN_FOV, TRUNK, RobotDescription, read_description
from hsr8.robots.file.files import package_folders, reading_models, stamp_of
from hsr8.robots.file.key_mistake import KeyMistake, reading_keys
from hsr8.robots.file.locate import find_description, find_model, model_files
from hsr8.robots.file.read import ModelFile, compile_spec, drop_drawn_meshes, read_spec
from hsr8.robots.file.urdf import drop_invalid_meshes
from hsr8.robots.model.linkage import drive_serially
from hsr8.robots.model.normal_form import normalise
from hsr8.robots.model.posed_shapes import arm_spheres, exclude_neighbours, robot_radius
from hsr8.robots.model.prepare import prepare, turn_base
from hsr8.robots.model.servos import choose_servos
from hsr8.robots.model.stated import set_efforts, set_ranges
from hsr8.robots.model.tree import tree_of
from hsr8.robots.parts.posture import check_joint_names, completed_posture, stated_posture
from hsr8.robots.parts.prepared import Prepared, moving_body
from hsr8.robots.parts.roles import Roles, base_frame, base_note, find_roles, present
from hsr8.robots.parts.skeleton import HINGE, SAME, BaseFrame, Posed
from hsr8.robots.parts.soles import soles_of
from hsr8.robots.walk.fitting import fitted_parameters, head_limits
from walking.body.robot_model import RobotModel
from walking.parameters import WalkingParameters

Array = NDArray[np.float64]


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
    set_ranges(spec, description.range)
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
    set_efforts(spec, description.effort)
    feet = [moving_body(spec.body(foot), prepared.root) for foot in description.feet]
    light = [] if description.camera is None else feet
    fresh = spec.copy()  # a copy loses references to missing elements, which `spec` reports
    model, mesh_notes = _compiled(source, spec, light)
    if mesh_notes:
        drop_invalid_meshes(fresh)
    prepared = replace(prepared, spec=fresh)
    notes = [*source.notes, *prepared.notes, *mesh_notes]
    frame = _frame(model, description, prepared)
    if not frame.is_body:
        notes += base_note(model, frame, prepared.base)
        turn_base(fresh, prepared.root, frame)
        before = Posed.at(model, {}, base=frame)
        model, _ = _compiled(source, fresh.copy(), light)
        require_same(before, Posed.at(model, {}), str(model_file))
    speed = {**source.speed, **description.speed}
    if description.linkage is not None:
        carried, linkage_notes = drive_serially(prepared, description, speed)
        speed = {**carried, **speed}
        notes += linkage_notes
        set_efforts(fresh, description.effort)
        model, _ = _compiled(source, fresh.copy(), light)
    return RawRobot(model_file, prepared, model, posture, speed, tuple(notes))


def _compiled(
    source: ModelFile, spec: mujoco.MjSpec, feet: list[str]
) -> tuple[mujoco.MjModel, list[str]]:
    """Compile a model; return notes on the meshes that are left out.

    Args:
        source: file of the model.
        spec: specification; it is slow to change afterwards.
        feet: bodies whose drawn meshes are needed; all of the robot are if there are none.
    """
    if feet:
        drop_drawn_meshes(spec, feet)
    return compile_spec(source, spec)


def _frame(model: mujoco.MjModel, description: RobotDescription, prepared: Prepared) -> BaseFrame:
    """Return the frame of the base; that of its body where the roles are to be refused."""
    try:
        return base_frame(model, description, prepared)
    except KeyMistake:
        return SAME


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
    set_ranges(spec, ranges)
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
    require_same(zero, Posed.at(compiled, straight), source)
    tree = tree_of(compiled, roles, normal.parts, posture, raw.speed)
    robot = RobotModel(tree)
    parameters, walk_notes = fitted_parameters(robot, description, source)
    driven = set(tree.names)
    held = {name: angle for name, angle in posture.items() if name not in driven}
    base = parameters.pattern.pelvis_height - robot.legs[0].hip[2]
    angles = dict(zip(tree.names, robot.ready.tolist(), strict=True))
    standing = Posed.at(compiled, {**held, **angles}, base)
    collision_notes = exclude_neighbours(normal.spec, standing, roles, source)
    parameters = replace(parameters, head=head_limits(standing, robot, description))
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
