"""Loading of an inspected robot, with changes of the guessed description that it needs."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from hsr8.robots.description import RobotDescription
from hsr8.robots.guess import Finding
from hsr8.robots.inspection import Inspection
from hsr8.robots.loaded import LoadedRobot, build_robot
from hsr8.robots.read_model import read_model
from hsr8.robots.self_collision import SelfCollision
from hsr8.robots.skeleton import Skeleton, root_of, skeleton_of
from walking.body.robot_model import MAX_STIFFENING

SPREADS = (0.15, 0.3, 0.5)  # angles of the arms from the trunk that are tried [rad]
SIDEWAYS = 0.7  # minimum cosine between forward and the axis of a joint that spreads an arm [1]


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
    try:
        robot = build_robot(description, inspection.file)
    except SelfCollision as error:
        inspection, robot = _with_spread_arms(inspection, error)
    if description.servo is not None or robot.model.stiffening < MAX_STIFFENING:
        return inspection, robot
    held = 1.0 / (robot.model.stiffening * robot.model.measures().ankle)
    reason = f"the ankles of the model have {held:.0%} of the stiffness that holds it upright"
    inspection = _changed(inspection, Finding("servo", "rule", "likely", reason), {"servo": "rule"})
    return inspection, build_robot(inspection.require_description(), inspection.file)


def _with_spread_arms(
    inspection: Inspection, refusal: SelfCollision
) -> tuple[Inspection, LoadedRobot]:
    """Return the robot with its arms off the body.

    Raises:
        ModelError: the robot is still refused.
    """
    description = inspection.require_description()
    for posture in _spread_postures(inspection, description):
        angles = ", ".join(f"{name} {angle:g}" for name, angle in posture.items())
        finding = Finding("posture", angles, "likely", "the arms touch the body at zero angles")
        tried = _changed(inspection, finding, {"posture": posture})
        try:
            return tried, build_robot(tried.require_description(), tried.file)
        except SelfCollision:
            continue
    raise refusal


def _spread_postures(
    inspection: Inspection, description: RobotDescription
) -> Iterator[dict[str, float]]:
    """Yield postures with the arms at several angles from the trunk [rad]."""
    if description.shoulders is None:
        return
    raw = read_model(inspection.model, description, inspection.model.parent)
    model = raw.spec.compile()
    skeleton = skeleton_of(model, root_of(model))
    left, right = description.shoulders
    rolls = [_shoulder_roll(skeleton, left, right), _shoulder_roll(skeleton, right, left)]
    for spread in SPREADS:
        posture = dict(description.posture)
        for side, roll in zip((1.0, -1.0), rolls, strict=True):
            if roll is not None:
                sign = side * float(np.sign(skeleton.axes[roll, 0]))
                angle = posture.get(skeleton.joints[roll], 0.0) + sign * spread
                angle = float(np.clip(angle, *skeleton.ranges[roll]))
                posture[skeleton.joints[roll]] = round(angle, 4)
        yield posture


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
