"""Inspection of a model file: guessed roles, the description that follows, and its robot."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import tomlkit

from hsr8.errors import ModelError
from hsr8.robots.defaults import navigation_speed
from hsr8.robots.file.description import (
    MODEL_SUFFIXES,
    RobotDescription,
    checked,
    read_description,
)
from hsr8.robots.file.key_mistake import KeyMistake, RepairableError
from hsr8.robots.file.locate import find_description, find_model
from hsr8.robots.file.read import compile_spec, drop_drawn_meshes, read_spec
from hsr8.robots.loaded import LoadedRobot, RawRobot, build_robot, read_robot
from hsr8.robots.model.posed_shapes import SelfCollision
from hsr8.robots.model.prepare import prepare
from hsr8.robots.parts.guess import Finding, Guess, guess
from hsr8.robots.parts.prepared import Prepared
from hsr8.robots.parts.roles import base_frame, find_roles
from hsr8.robots.parts.skeleton import HINGE, Posed, Skeleton, root_of, skeleton_of
from hsr8.robots.parts.soles import flat_feet
from hsr8.robots.walk.rehearsal import postures
from hsr8.version import VERSION
from walking.body.robot_model import MAX_STIFFENING
from walking.command import VelocityCommand

SPREADS = (0.15, 0.3, 0.5)  # angles of the arms from the trunk that are tried [rad]
BENDS = (0.7, 1.1, 1.5)  # angles of the elbows that are tried [rad]
POSTURE_TICKS = 8  # control ticks between the postures of a walk in which parts may touch
SIDEWAYS = 0.7  # minimum cosine between forward and the axis of a joint that spreads an arm [1]


@dataclass(frozen=True, slots=True)
class Inspection:
    """Roles of a robot's parts.

    Attributes:
        model: MJCF or URDF file.
        file: file of the description, or the model without one.
        description: stated or guessed; None where no feet were found.
        findings: guesses, one per role.
        notes: notes on the model file, a line each.
        stated: whether the description exists.
    """

    model: Path
    file: Path
    description: RobotDescription | None
    findings: tuple[Finding, ...]
    notes: tuple[str, ...]
    stated: bool

    def require_description(self) -> RobotDescription:
        """Return the description.

        Raises:
            ModelError: no feet were found; the message has the reason.
        """
        if self.description is None:
            reason = next(f.reason for f in self.findings if f.role == "feet")
            raise ModelError(f"{self.model}: feet: {reason}")
        return self.description


def inspect(name_or_file: str) -> Inspection:
    """Guess the roles of a robot's parts.

    Args:
        name_or_file: MJCF or URDF file, or a description by name or file.

    Raises:
        ModelError: a file is missing or cannot be read.
    """
    file = find_description(name_or_file).absolute()
    if file.suffix.lower() not in MODEL_SUFFIXES:
        description = read_description(file)
        raw = read_robot(description, file)
        findings = guess(raw.model).findings
        model_file = find_model(description, file)
        return Inspection(model_file, file, description, findings, raw.notes, stated=True)
    keys, repairs = dict[str, Any](), list[Finding]()
    try:
        model, prepared, notes = _prepared(file, keys)
    except RepairableError as error:
        keys, repairs = error.keys, list(_repairs(error, file))
        model, prepared, notes = _prepared(file, keys)
    guessed = guess(model)
    if guessed.feet is None and "follows a joint" in prepared.held.values():
        # A coupled joint of a leg is none of its joints while it is held.
        led = _prepared(file, {**keys, "hold_followers": False})
        if (coupled := guess(led[0])).feet is not None:
            (model, prepared, notes), guessed = led, coupled
    findings = (*guessed.findings, *repairs)
    if guessed.feet is None:
        return Inspection(file, file, None, findings, tuple(notes), stated=False)
    description = checked({"model": str(file), **guessed.keys(), **keys}, str(file))
    zero = _flat_feet(model, description, guessed, prepared)
    if zero:
        angles = ", ".join(f"{name} {angle:g}" for name, angle in zero.items())
        reason = "the soles are tilted at zero angles"
        findings = (*findings, Finding("zero", angles, "likely", reason))
        description = description.model_copy(update={"zero": zero})
    return Inspection(file, file, description, findings, tuple(notes), stated=False)


def _prepared(file: Path, keys: dict[str, Any]) -> tuple[mujoco.MjModel, Prepared, list[str]]:
    """Return a model file, compiled and prepared without a description, and its notes."""
    source = read_spec(file, {})
    prepared = prepare(source, None, posture={}, **keys)
    model, notes = compile_spec(source, source.spec)
    return model, prepared, [*source.notes, *prepared.notes, *notes]


def _repairs(error: RepairableError, model: Path) -> Iterator[Finding]:
    """Yield a finding per key that repairs a fault of a model file."""
    reason = str(error).removeprefix(f"{model}: ").partition(";")[0]
    for key, value in error.keys.items():
        yield Finding(key, str(value).lower(), "likely", reason)


def _flat_feet(
    model: mujoco.MjModel, description: RobotDescription, guessed: Guess, prepared: Prepared
) -> dict[str, float]:
    """Return the angles of ankles with which the soles are flat, where they are not [rad]."""
    try:
        roles = find_roles(model, description, prepared)
    except KeyMistake:  # loading the robot reports it
        return {}
    frame = base_frame(model, description, prepared)
    return flat_feet(model, roles.feet, guessed.legs, frame)


def description_text(inspection: Inspection, file: Path, command: str) -> str:
    """Return the text of a guessed description; comments have the reason of each guess.

    Args:
        inspection: inspection of a model, with a description.
        file: file to be written, next to which the model may be.
        command: command line that guessed the roles.
    """
    keys = inspection.require_description().model_dump(mode="json", exclude_defaults=True)
    model, folder = inspection.model.resolve(), file.resolve().parent
    keys["model"] = str(model.relative_to(folder) if model.is_relative_to(folder) else model)
    tables = [key for key, value in keys.items() if isinstance(value, dict)]
    reasons = {f.role: f"{f.sureness}: {f.reason}" for f in inspection.findings}
    document = tomlkit.document()
    document.add(tomlkit.comment(f"Guessed by {command}, version {VERSION}: check every line."))

    def add(key: str) -> None:
        item = tomlkit.item(keys[key])
        if key in reasons:
            item.comment(reasons[key])
        document.add(key, item)

    for key in (key for key in keys if key not in tables):
        add(key)
    for finding in inspection.findings:
        if finding.role not in keys:
            text = finding.part or finding.sureness
            document.add(tomlkit.comment(f"{finding.role}: {text}: {finding.reason}"))
    for key in tables:
        add(key)
    return tomlkit.dumps(document)


def facts(robot: LoadedRobot) -> dict[str, Any]:
    """Return the numbers of a robot; keys end in their units."""
    measures, parameters, sole = robot.model.measures(), robot.parameters, robot.model.sole
    return {
        "mass_kg": robot.model.mass,
        "leg_m": measures.leg,
        "hips_m": parameters.pattern.pelvis_height,
        "joints": sum(joint.type == HINGE for joint in robot.spec.joints),
        "walking_joints": len(robot.model.names),
        "sole_m": [2.0 * sole.half_length, 2.0 * sole.half_width],
        "stance_m": 2.0 * parameters.gait.half_stance,
        "radius_m": robot.radius,
        "head": robot.roles.head is not None,
        "stiffened": robot.model.stiffening,
        "footstep_time_s": parameters.gait.footstep_time,
        "swing_height_m": parameters.gait.swing_height,
        "vx_mps": parameters.limits.vx,
        "vx_backward_mps": parameters.limits.vx_backward,
        "vy_mps": parameters.limits.vy,
        "wz_radps": parameters.limits.wz,
        "calibrated": robot.description.calibration is not None,
    }


def load_inspected(inspection: Inspection) -> tuple[Inspection, LoadedRobot]:
    """Load a robot.

    A guessed description is changed where the robot cannot stand with it: arms that touch the body
    are spread, and servos that are too soft are replaced by the rule.

    Returns:
        The inspection with its changes, and the robot.

    Raises:
        ModelError: the robot is refused.
    """
    description = inspection.require_description()
    if inspection.stated:
        return inspection, build_robot(description, inspection.file)
    raw = read_robot(description, inspection.file)
    try:
        robot = build_robot(description, inspection.file, raw)
    except RepairableError as error:
        if all(getattr(description, key) == value for key, value in error.keys.items()):
            raise  # tried in vain
        (finding,) = _repairs(error, inspection.model)
        return load_inspected(_changed(inspection, finding, error.keys))
    except SelfCollision as error:
        inspection, robot = _with_spread_arms(inspection, raw, error)
    if touching_parts(robot):
        inspection, robot = _with_free_arms(inspection, raw, robot)
    if description.servo is not None or robot.model.stiffening < MAX_STIFFENING:
        return inspection, robot
    held = 1.0 / (robot.model.stiffening * robot.model.measures().ankle)
    reason = f"the ankles of the model have {held:.0%} of the stiffness that holds it upright"
    inspection = _changed(inspection, Finding("servo", "rule", "likely", reason), {"servo": "rule"})
    return inspection, build_robot(inspection.require_description(), inspection.file, raw)


def touching_parts(robot: LoadedRobot) -> set[tuple[str, str]]:
    """Return the bodies that touch each other while the robot walks at its speed limits."""
    spec, speed = robot.spec.copy(), navigation_speed(robot)
    drop_drawn_meshes(spec, robot.roles.feet)
    model, touching = spec.compile(), set[tuple[str, str]]()
    for side in (1.0, -1.0):
        command = VelocityCommand(speed["vx"], side * speed["vy"], speed["wz"])
        for angles in postures(robot.model, robot.parameters, command)[::POSTURE_TICKS]:
            joints = dict(zip(robot.model.names, angles.tolist(), strict=True))
            data = Posed.at(model, {**robot.held, **joints}).data
            pairs = np.sort(model.geom_bodyid[data.contact.geom], axis=1).tolist()
            touching |= {(model.body(a).name, model.body(b).name) for a, b in pairs}
    return touching


def _with_free_arms(
    inspection: Inspection, raw: RawRobot, robot: LoadedRobot
) -> tuple[Inspection, LoadedRobot]:
    """Return the robot with a posture in which its arms touch nothing while it walks, if any."""
    description = inspection.require_description()
    for posture in _spread_postures(raw, description):
        reason = "the arms touch the legs while walking"
        tried = _changed(inspection, _posture_finding(posture, reason), {"posture": posture})
        try:
            changed = build_robot(tried.require_description(), tried.file, raw)
        except SelfCollision:
            continue
        if not touching_parts(changed):
            return tried, changed
    return inspection, robot


def _posture_finding(posture: dict[str, float], reason: str) -> Finding:
    angles = ", ".join(f"{name} {angle:g}" for name, angle in posture.items())
    return Finding("posture", angles, "likely", reason)


def _with_spread_arms(
    inspection: Inspection, raw: RawRobot, refusal: SelfCollision
) -> tuple[Inspection, LoadedRobot]:
    """Return the robot with its arms off the body.

    Raises:
        ModelError: the robot is still refused.
    """
    description = inspection.require_description()
    for posture in _spread_postures(raw, description):
        finding = _posture_finding(posture, "the arms touch the body at zero angles")
        tried = _changed(inspection, finding, {"posture": posture})
        try:
            return tried, build_robot(tried.require_description(), tried.file, raw)
        except SelfCollision:
            continue
    raise refusal


def _spread_postures(raw: RawRobot, description: RobotDescription) -> Iterator[dict[str, float]]:
    """Yield postures with the arms off the trunk, or bent at the elbows [rad]."""
    if description.shoulders is None:
        return
    skeleton = skeleton_of(raw.model, root_of(raw.model))
    left, right = description.shoulders
    rolls = [_shoulder_roll(skeleton, left, right), _shoulder_roll(skeleton, right, left)]
    elbows = [_elbow(skeleton, left), _elbow(skeleton, right)]
    for joints, axis, turns, signs in (
        (rolls, 0, SPREADS, (1.0, -1.0)),
        (elbows, 1, BENDS, (-1.0, -1.0)),
    ):
        for turn in turns if None not in joints else ():
            posture = dict(description.posture)
            for sign, joint in zip(signs, joints, strict=True):
                assert joint is not None
                angle = sign * float(np.sign(skeleton.axes[joint, axis])) * turn
                angle += posture.get(skeleton.joints[joint], 0.0)
                angle = float(np.clip(angle, *skeleton.ranges[joint]))
                posture[skeleton.joints[joint]] = round(angle, 4)
            yield posture


def _elbow(skeleton: Skeleton, shoulder: str) -> int | None:
    """Return the first joint below the pitch joint of a shoulder that pitches, too."""
    pitch = skeleton.joints.index(shoulder)
    return next(
        (
            j
            for j in range(len(skeleton.joints))
            if j != pitch and pitch in skeleton.chain(j) and skeleton.is_pitch(j)
        ),
        None,
    )


def _shoulder_roll(skeleton: Skeleton, shoulder: str, other: str) -> int | None:
    """Return the joint nearest to the pitch joint of a shoulder that moves its arm sideways."""
    pitch, opposite = (skeleton.joints.index(name) for name in (shoulder, other))
    trunk = skeleton.chain(opposite)
    arm = [
        j
        for j in range(len(skeleton.joints))
        if (pitch in skeleton.chain(j) or j in skeleton.chain(pitch)) and j not in trunk
    ]
    rolls = [j for j in arm if abs(skeleton.axes[j, 0]) > SIDEWAYS]
    origin = skeleton.anchors[pitch]
    return min(
        rolls, key=lambda j: float(np.linalg.norm(skeleton.anchors[j] - origin)), default=None
    )


def _changed(inspection: Inspection, finding: Finding, keys: dict[str, Any]) -> Inspection:
    """Return the inspection with other keys of its description, and the finding for them."""
    description = inspection.require_description().model_copy(update=keys)
    others = tuple(f for f in inspection.findings if f.role != finding.role)
    return replace(inspection, description=description, findings=(*others, finding))
