"""Guess of the roles of a robot's parts from its kinematic tree; names come second."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import atan2, cos, sin
from typing import Any, Literal

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.parts.limbs import (
    Limb,
    Stance,
    find_stance,
    foot_joint,
    no_stance,
    not_hinged,
    side_vote,
    size_of,
    toe_vote,
    turned_back,
)
from hsr8.robots.parts.skeleton import LEG_JOINTS, PARALLEL, Skeleton, root_of, skeleton_of

Array = NDArray[np.float64]
Sureness = Literal["certain", "likely", "unsure", "missing"]
Pair = tuple[str, str]

MAX_HEAD = 0.2  # mass of a head in masses of the robot [1]
MID_PLANE = 0.03  # distance of the yaw axis of a neck from the mid plane, in sizes of the robot [1]
MID_HEAD = 0.08  # distance of the mass of a head from that plane [1]
SHOULDER = 0.15  # extent of a shoulder, in sizes of the robot [1]
SIDEWAYS = 0.7  # minimum cosine between an arm that is to be lowered and the left [1]
SPREAD = 0.25  # angle of hanging arms from the vertical [rad]


@dataclass(frozen=True, slots=True, eq=False)
class MountedCamera:
    """Camera of a model.

    Attributes:
        name: name of the camera.
        group: index of the joint that moves it, -1 for the base.
        direction: direction of its optical axis in the root (3,).
    """

    name: str
    group: int
    direction: Array


@dataclass(frozen=True, slots=True)
class Finding:
    """Role with its part, or the reason why no part has it."""

    role: str
    part: str
    sureness: Sureness
    reason: str


@dataclass(frozen=True, slots=True)
class Guess:
    """Roles of a robot; None where no part fits.

    Attributes:
        base: root body.
        feet: bodies of the left and the right foot.
        legs: joints of the left and the right leg, hip first.
        head: pan and tilt joint.
        shoulders: left and right pitch joint.
        camera: name.
        posture: angles that let sideways arms hang down [rad].
        findings: findings for the user, one per role.
    """

    base: str
    feet: Pair | None = None
    legs: tuple[tuple[str, ...], tuple[str, ...]] = ((), ())
    head: Pair | None = None
    shoulders: Pair | None = None
    camera: str | None = None
    posture: dict[str, float] | None = None
    findings: tuple[Finding, ...] = ()

    def keys(self) -> dict[str, Any]:
        """Return the keys of a description other than its model."""
        names = ("feet", "base", "head", "shoulders", "camera", "posture")
        return {name: value for name in names if (value := getattr(self, name))}


def guess(model: mujoco.MjModel) -> Guess:
    """Guess the roles of the robot in a compiled model."""
    skeleton = skeleton_of(model, root_of(model))
    roles = guess_roles(skeleton, tuple(_views(model, skeleton)))
    base = Finding("base", skeleton.root, "certain", "has the free joint")
    return replace(roles, findings=(base, *roles.findings))


def guess_roles(skeleton: Skeleton, cameras: Sequence[MountedCamera] = ()) -> Guess:
    """Guess the roles of a robot at zero angles.

    Args:
        skeleton: skeleton in the frame of its root, whose directions are arbitrary.
        cameras: cameras of the model.
    """
    stance = find_stance(skeleton)
    if stance is None:
        missing = Finding("feet", "", "missing", no_stance(skeleton))
        return Guess(skeleton.root, findings=(missing,))
    stance, forward = _facing(stance)
    feet, legs, feet_finding = _feet(stance)
    head, head_finding = _head(stance)
    arms = _arms(stance, head)
    shoulders, shoulders_finding = _shoulders(stance, arms)
    limbs = {*stance.legs.left, *stance.legs.right}
    limbs |= set() if arms is None else {*arms.left, *arms.right}
    fixed = [c for c in cameras if not limbs & {*stance.skeleton.chain(c.group)}]
    camera, camera_finding = _camera(stance, head, fixed)
    posture = {} if arms is None else dict(_hanging(stance.skeleton, arms))
    findings = [forward, feet_finding, head_finding, shoulders_finding, camera_finding]
    if posture:
        angles = ", ".join(f"{name} {angle:g}" for name, angle in posture.items())
        reason = "the arms point sideways at zero angles"
        findings.append(Finding("posture", angles, "likely", reason))
    return Guess(
        base=skeleton.root,
        feet=feet,
        legs=legs,
        head=None if head is None else (skeleton.joints[head[0]], skeleton.joints[head[1]]),
        shoulders=shoulders,
        camera=camera,
        posture=posture,
        findings=tuple(findings),
    )


def _facing(stance: Stance) -> tuple[Stance, Finding]:
    """Return the stance that faces forward."""
    votes = {
        "knees bend forward": (3, _knee_vote(stance)),
        "names of left and right": (3, _name_vote(stance)),
        "feet are longer in front": (1, toe_vote(stance.skeleton, *_to_feet(stance))),
        "x of the root": (1, int(np.sign(round(float(stance.rotation[0, 0]))))),
    }
    total = sum(weight * vote for weight, vote in votes.values())
    if total < 0:
        stance = turned_back(stance)
    sign = -1 if total < 0 else 1
    pro = [reason for reason, (_, vote) in votes.items() if sign * vote > 0]
    contra = [reason for reason, (_, vote) in votes.items() if sign * vote < 0]
    strong = any(sign * vote > 0 for weight, vote in votes.values() if weight > 1)
    sureness: Sureness = "certain" if strong and not contra else "likely" if strong else "unsure"
    reason = ", ".join(pro) or "nothing shows where the front is"
    if contra:
        reason += f"; against it: {', '.join(contra)}"
    axis = int(np.abs(stance.rotation[0]).argmax())
    direction = f"{'-' if stance.rotation[0, axis] < 0.0 else '+'}{'xyz'[axis]}"
    part = f"{direction} of {stance.skeleton.root}"
    return stance, Finding("forward", part, sureness, reason)


def _to_feet(stance: Stance) -> list[tuple[int, ...]]:
    """Return the joints of both legs down to the foot, without toes."""
    last = foot_joint(stance.skeleton, stance.legs.left)
    return [leg[: last + 1] for leg in (stance.legs.left, stance.legs.right)]


def _knee_vote(stance: Stance) -> int:
    """Return 1 if the ranges let the knees bend forward, -1 if backward, else 0."""
    return int(np.sign(sum(stance.skeleton.bend(leg[-LEG_JOINTS:]) for leg in _to_feet(stance))))


def _name_vote(stance: Stance) -> int:
    """Return 1 if the names of the legs differ as left and right do, -1 if as right and left."""
    left, right = (leg[-1] for leg in (stance.legs.left, stance.legs.right))
    names = stance.skeleton.bodies, stance.skeleton.joints
    return next((vote for part in names if (vote := side_vote(part[left], part[right]))), 0)


def _feet(stance: Stance) -> tuple[Pair | None, tuple[tuple[str, ...], tuple[str, ...]], Finding]:
    skeleton = stance.skeleton
    left, right = _to_feet(stance)
    names = [", ".join(skeleton.joints[j] for j in leg) for leg in (left, right)]
    if len(left) < LEG_JOINTS:
        reason = (
            f"the legs have {len(left)} hinge joints, {names[0]} and {names[1]}; hsr8 needs "
            f"{LEG_JOINTS}: three at the hip, a knee, two at the ankle"
        )
        if skeleton.others:
            reason = not_hinged(skeleton.others[0])
        return None, ((), ()), Finding("feet", "", "missing", reason)
    six = left[-LEG_JOINTS:], right[-LEG_JOINTS:]
    feet = skeleton.bodies[left[-1]], skeleton.bodies[right[-1]]
    pitching = len(skeleton.pitching(six[0]))
    sureness: Sureness = "certain" if pitching == 3 else "unsure"
    reason = f"mirrored chains of {len(left)} joints that end lowest"
    if pitching != 3:
        reason += f", of which {pitching} pitch; expected 3"
    if toes := [skeleton.joints[j] for j in stance.legs.left[len(left) :]]:
        reason += f", without the toes beyond {toes[0]}"
    legs = tuple(skeleton.joints[j] for j in six[0]), tuple(skeleton.joints[j] for j in six[1])
    return feet, legs, Finding("feet", ", ".join(feet), sureness, reason)


def _head(stance: Stance) -> tuple[tuple[int, int] | None, Finding]:
    """Return the pan and the tilt joint: on the mid plane, above the hips, of a light part.

    The part carries no limbs, and its mass is on the mid plane, as a trunk and an arm do not.
    """
    skeleton, plane = stance.skeleton, stance.legs.plane
    size, hip = size_of(skeleton), float(skeleton.anchors[stance.legs.left[0], 2])
    limbs = {limb.left[0] for limb in stance.limbs if len(limb.left) > 1}

    def fits(joint: int) -> bool:
        light = skeleton.mass_below(joint) < MAX_HEAD * skeleton.total_mass
        carries = any(joint in skeleton.chain(limb) for limb in limbs)
        return light and not carries and bool(skeleton.anchors[joint, 2] > hip)

    def central(joint: int) -> bool:
        return bool(abs(skeleton.com_below(joint)[1] - plane) < MID_HEAD * size)

    upper = [j for j in range(len(skeleton.joints)) if fits(j) and central(j)]
    pans = [
        j
        for j in upper
        if skeleton.is_yaw(j) and abs(skeleton.anchors[j, 1] - plane) < MID_PLANE * size
    ]
    pairs = [
        (pan, tilt)
        for pan in pans
        for tilt in upper
        if skeleton.is_pitch(tilt) and (pan in skeleton.chain(tilt) or tilt in skeleton.chain(pan))
    ]
    if not pairs:
        reason = "no joint on the mid plane yaws a light upper part"
        if pans:
            reason = f"{skeleton.joints[pans[0]]} yaws, but no joint pitches with it"
        return None, Finding("head", "", "missing", f"{reason}: the camera is fixed to the trunk")

    def preference(pair: tuple[int, int]) -> tuple[bool, float, int]:
        pan, tilt = pair
        distance = abs(len(skeleton.chain(pan)) - len(skeleton.chain(tilt)))
        return pan in skeleton.chain(tilt), float(skeleton.anchors[pan, 2]), -distance

    pan, tilt = max(pairs, key=preference)
    names = f"{skeleton.joints[pan]}, {skeleton.joints[tilt]}"
    if skeleton.parents[tilt] == pan:
        return (pan, tilt), Finding(
            "head", names, "certain", "yaws, then pitches, on the mid plane"
        )
    order = "other joints between" if pan in skeleton.chain(tilt) else "pitches, then yaws"
    return (pan, tilt), Finding("head", names, "likely", f"on the mid plane; {order}")


def _arms(stance: Stance, head: tuple[int, int] | None) -> Limb | None:
    """Return the heaviest limb above the hips that the head does not carry."""
    skeleton = stance.skeleton
    hip = float(skeleton.anchors[stance.legs.left[0], 2])
    arms = [
        limb
        for limb in stance.limbs
        if skeleton.anchors[limb.left[0], 2] > hip
        and not {*skeleton.chain(limb.left[0])} & {*(head or ())}
        and len(limb.left) > 1
    ]
    return max(arms, key=lambda limb: skeleton.mass_below(limb.left[0]), default=None)


def _shoulders(stance: Stance, arms: Limb | None) -> tuple[Pair | None, Finding]:
    """Return the first pitching joints of the arms."""
    if arms is None:
        return None, Finding("shoulders", "", "missing", "no mirrored chains above the hips")
    skeleton = stance.skeleton
    radius = SHOULDER * size_of(skeleton)
    for left, right in zip(arms.left, arms.right, strict=True):
        distance = np.linalg.norm(skeleton.anchors[left] - skeleton.anchors[arms.left[0]])
        if skeleton.is_pitch(left) and skeleton.is_pitch(right) and distance < radius:
            names = skeleton.joints[left], skeleton.joints[right]
            reason = "first pitching joints of mirrored chains above the hips"
            return names, Finding("shoulders", ", ".join(names), "certain", reason)
    names = skeleton.joints[arms.left[0]], skeleton.joints[arms.right[0]]
    reason = f"no pitching joint near {names[0]} and {names[1]}: the arms do not swing"
    return None, Finding("shoulders", "", "missing", reason)


def _hanging(skeleton: Skeleton, arms: Limb) -> Iterator[tuple[str, float]]:
    """Yield roll joints and angles that let sideways arms hang down [rad]."""
    for side, arm in ((1.0, arms.left), (-1.0, arms.right)):
        rolls = [j for j in arm if abs(skeleton.axes[j, 0]) > PARALLEL]
        if not rolls:
            return
        lever = skeleton.com_below(rolls[0]) - skeleton.anchors[rolls[0]]
        if side * lever[1] < SIDEWAYS * np.linalg.norm(lever):
            return
        axis = skeleton.axes[rolls[0]]
        goal = np.array([0.0, side * sin(SPREAD), -cos(SPREAD)])
        along = float(lever @ goal - (axis @ lever) * (axis @ goal))
        angle = atan2(float(axis @ np.cross(lever, goal)), along)
        yield skeleton.joints[rolls[0]], round(float(np.clip(angle, *skeleton.ranges[rolls[0]])), 2)


def _camera(
    stance: Stance, head: tuple[int, int] | None, cameras: Sequence[MountedCamera]
) -> tuple[str | None, Finding]:
    """Return a camera that looks forward, in the head if there is one."""
    forward = [c for c in cameras if float(stance.rotation[0] @ c.direction) > 0.5]
    if not forward:
        reason = "none looks forward from the robot" if cameras else "the robot has none"
        return None, Finding("camera", "", "missing", f"{reason}: one is mounted in front")
    moved = max(head) if head else -1
    in_head = [c for c in forward if moved in stance.skeleton.chain(c.group)] if head else []
    choices = in_head or forward
    names = ", ".join(c.name for c in choices[1:])
    reason = "looks forward" + (" from the head" if in_head else "")
    if names:
        return choices[0].name, Finding(
            "camera", choices[0].name, "unsure", f"{reason}; or {names}"
        )
    return choices[0].name, Finding("camera", choices[0].name, "certain", reason)


def _views(model: mujoco.MjModel, skeleton: Skeleton) -> Iterator[MountedCamera]:
    """Yield the cameras that are fixed to the robot, at zero angles."""
    data = mujoco.MjData(model)
    for j in range(model.njnt):
        if model.joint(j).name in skeleton.joints:
            data.qpos[model.jnt_qposadr[j]] = 0.0
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_camlight(model, data)
    root = data.xmat[root_of(model)].reshape(3, 3)
    fixed = int(mujoco.mjtCamLight.mjCAMLIGHT_FIXED)
    for c in range(model.ncam):
        body = model.body(model.cam_bodyid[c]).name
        if model.cam_mode[c] == fixed and body in skeleton.group and model.camera(c).name:
            direction = -data.cam_xmat[c].reshape(3, 3)[:, 2] @ root
            yield MountedCamera(model.camera(c).name, skeleton.group[body], direction)
