"""Refusal of robots that cannot walk: legs, base, head, shoulders and posture.

Every check raises one `ModelError` with the element, the reason and the remedy.
"""

from collections.abc import Sequence
from math import degrees

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.description import RobotDescription
from hsr8.robots.key_mistake import KeyMistake, joint_error
from hsr8.robots.mechanism_checks import check_mechanism
from hsr8.robots.mirror import mirrored_pairs
from hsr8.robots.roles import Roles
from hsr8.robots.skeleton import Skeleton, skeleton_of

Array = NDArray[np.float64]

UPRIGHT = np.cos(np.radians(20.0))  # minimum cosine between the hips above the feet and z [1]
ABREAST = np.cos(np.radians(10.0))  # minimum cosine between the line of the feet and y [1]
MAX_SHIFT = 0.01  # of a mirrored joint axis, in lengths of the leg [1]
MAX_TURN = np.radians(1.0)  # of a mirrored joint axis [rad]
MAX_RANGE_DIFFERENCE = 0.1  # of mirrored limits [rad]
PITCHING = ("hip", "knee", "ankle")
BENT = (-0.4, 0.8, -0.35)  # pitch of hip, knee and ankle in a bent leg, about the left axis [rad]
MIN_FREEDOM = 0.01  # singular value of the scaled Jacobian of a bent leg, minimum over maximum [1]
SLACK = 1e-6  # of limits [rad]
MAX_CAMERA = 2.0  # distance of a camera from the origin of its body, in lengths of the leg [1]


def check_roles(
    model: mujoco.MjModel, roles: Roles, description: RobotDescription, source: str
) -> None:
    """Refuse a robot that cannot walk.

    Args:
        model: compiled.
        roles: of its parts.
        description: of the robot.
        source: model file, which begins the messages about its elements.

    Raises:
        KeyMistake: a key of the description is wrong.
        ModelError: an element of the model is wrong.
    """
    check_mechanism(model, roles, description, source)
    check = _Checks(model, roles, description, source)
    check.ranges()
    check.base()
    check.sides()
    check.pitching()
    check.bending()
    check.mirror()
    check.freedom()
    check.head()
    check.shoulders()
    check.camera()


class _Checks:
    def __init__(
        self,
        model: mujoco.MjModel,
        roles: Roles,
        description: RobotDescription,
        source: str,
    ) -> None:
        self._model, self._roles = model, roles
        self._description, self._source = description, source
        self._skeleton = self._posed({})
        left, right = roles.legs
        index = self._skeleton.joints.index
        self._legs = ([index(name) for name in left], [index(name) for name in right])
        hips, feet = ([leg[end] for leg in self._legs] for end in (0, -1))
        self._hips_above_feet = self._skeleton.anchors[hips] - self._skeleton.anchors[feet]
        self._across = np.subtract(*self._skeleton.coms[feet])

    def _posed(self, more: dict[str, float]) -> Skeleton:
        base = self._model.body(self._roles.base).id
        return skeleton_of(self._model, base, {**self._description.zero, **more})

    def _range_error(self, joint: str, reason: str) -> ModelError:
        return joint_error(joint, "range", self._description, self._source, reason)

    def ranges(self) -> None:
        """Stated angles must lie within the limits; `posture` excludes legs and head."""
        robot, index = self._description, {n: k for k, n in enumerate(self._skeleton.joints)}
        leg = {name for leg in self._roles.legs for name in leg}
        for key, other in ((robot.zero, "zero"), (robot.posture, "posture")):
            for name, angle in key.items():
                lower, upper = self._skeleton.ranges[index[name]]
                if not lower - SLACK <= angle <= upper + SLACK:
                    raise KeyMistake(
                        f"{other}.{name}: outside the range of the joint, got {angle:g} rad; "
                        f"expected {lower:.3g} to {upper:.3g}"
                    )
        for name in robot.posture:
            if name in leg or name in (robot.head or ()):
                part = "leg" if name in leg else "head"
                raise KeyMistake(
                    f"posture.{name}: a joint of the {part}, which moves while walking; expected "
                    "joints other than legs and head: leave it out"
                )

    def base(self) -> None:
        """The base must have z up and x forward."""
        base = f"base: body {self._roles.base!r}"
        up = self._hips_above_feet.mean(axis=0)
        if np.linalg.norm(self._across) < 1e-6 or np.linalg.norm(up) < 1e-6:
            raise KeyMistake(
                "feet: at zero angles the feet are at one point or at the hips; expected straight "
                "legs: state other angles as zero"
            )
        remedy = "turn its frame in the model, or state angles of straight legs as zero"
        if up[2] < UPRIGHT * np.linalg.norm(up):
            raise KeyMistake(
                f"{base}: z is not up at zero angles, got the hips in direction {_text(up)} from "
                f"the feet; expected (0, 0, 1): {remedy}"
            )
        if abs(self._across[1]) < ABREAST * np.linalg.norm(self._across):
            raise KeyMistake(
                f"{base}: x is not forward at zero angles, got the left foot in direction "
                f"{_text(self._across)} from the right one; expected (0, 1, 0): {remedy}"
            )

    def sides(self) -> None:
        """The left foot must be on the left, where the knees bend forward."""
        if self._across[1] > 0.0:
            return
        exchanged = "left and right are exchanged; expected the left foot first"
        backward = f"x of body {self._roles.base!r} points backward; expected x forward"
        left, right = self._roles.feet
        where = f"{left!r}, the first, is to the right of {right!r} in the base"
        bend = [_bend(self._skeleton, leg) for leg in self._legs]
        if min(bend) > 0.0:
            raise KeyMistake(f"feet: {where}: {exchanged}")
        if max(bend) < 0.0:
            raise KeyMistake(f"base: {where}, and the knees bend backward: {backward}")
        raise KeyMistake(f"feet: {where}: {exchanged}, or {backward}")

    def pitching(self) -> None:
        """A leg must have three joints that pitch at zero angles."""
        for leg, names in zip(self._legs, self._roles.legs, strict=True):
            pitching = [self._skeleton.joints[j] for j in leg if self._skeleton.is_pitch(j)]
            if len(pitching) != len(PITCHING):
                got = ", ".join(pitching) or "none"
                raise KeyMistake(
                    f"feet: of the leg {names[0]!r} to {names[-1]!r}, {len(pitching)} joints pitch "
                    f"at zero angles, got {got}; expected hip, knee and ankle"
                )

    def bending(self) -> None:
        """The ranges must include a bent leg."""
        for leg in self._legs:
            pitching = [j for j in leg if self._skeleton.is_pitch(j)]
            for part, joint, angle in zip(PITCHING, pitching, BENT, strict=True):
                lower, upper = _about_left(self._skeleton, joint)
                zero = self._zero(joint) * np.sign(self._skeleton.axes[joint, 1])
                if not lower - SLACK <= zero + angle <= upper + SLACK:
                    name = self._skeleton.joints[joint]
                    raise self._range_error(
                        name,
                        f"the {part} cannot bend, got a range of "
                        f"{lower - zero:.2f} to {upper - zero:.2f} rad about the left axis; "
                        f"expected {angle:g} in it: are left and right exchanged, x of the base "
                        "backward, or the limits wrong?",
                    )

    def mirror(self) -> None:
        """The right leg must be the mirror image of the left one."""
        size = float(np.linalg.norm(self._hips_above_feet.mean(axis=0)))
        left_leg, right_leg = self._legs
        for pair in mirrored_pairs(self._skeleton, left_leg, right_leg):
            left, right = (self._skeleton.joints[j] for j in (pair.left, pair.right))
            shift, turn = 1e3 * pair.distance, degrees(pair.angle)
            for wrong, reason in (
                (
                    pair.distance > MAX_SHIFT * size,
                    f"axes are {shift:.1f} mm apart; expected at most {1e3 * MAX_SHIFT * size:.1f}",
                ),
                (
                    pair.angle > MAX_TURN,
                    f"axes differ by {turn:.1f} deg; expected at most {degrees(MAX_TURN):.0f}",
                ),
                (
                    pair.range > MAX_RANGE_DIFFERENCE,
                    f"ranges differ by {pair.range:.2f} rad; expected at most "
                    f"{MAX_RANGE_DIFFERENCE:g}",
                ),
            ):
                if wrong:
                    one, other = (left, right) if left in self._description.range else (right, left)
                    raise self._range_error(
                        one,
                        f"not the mirror image of {other!r} in the plane y = 0 of "
                        f"the base at zero angles: {reason}: correct the model, or state angles "
                        "at which the legs are alike as zero, or the range",
                    )

    def freedom(self) -> None:
        """A bent leg must be able to move its foot in all six directions."""
        angles = {}
        for leg in self._legs:
            pitching = [j for j in leg if self._skeleton.is_pitch(j)]
            for joint, angle in zip(pitching, BENT, strict=True):
                sign = float(np.sign(self._skeleton.axes[joint, 1]))
                angles[self._skeleton.joints[joint]] = self._zero(joint) + sign * angle
        bent = self._posed(angles)
        for leg, names in zip(self._legs, self._roles.legs, strict=True):
            arms = bent.anchors[leg[-1]] - bent.anchors[leg]
            axes, size = bent.axes[leg], float(np.linalg.norm(arms[0]))
            jacobian = np.hstack([axes, np.cross(axes, arms) / size])
            values = np.linalg.svd(jacobian, compute_uv=False)
            if values[-1] < MIN_FREEDOM * values[0]:
                raise KeyMistake(
                    f"feet: the leg {names[0]!r} to {names[-1]!r} cannot move its foot in all "
                    "directions: two of its joints have equal effects; expected joints that yaw, "
                    "roll and pitch the hip, pitch the knee, and pitch and roll the ankle"
                )

    def head(self) -> None:
        """The head must yaw and pitch one part, and be able to look ahead."""
        if self._roles.head is None:
            return
        for name, (part, expected, axis) in zip(
            self._roles.head, (("pan", "yaw", 2), ("tilt", "pitch", 1)), strict=True
        ):
            self._require_axis(f"head: {part} joint", name, expected, axis)
            lower, upper = self._skeleton.ranges[self._skeleton.joints.index(name)]
            if not lower <= 0.0 <= upper:
                raise self._range_error(
                    name,
                    f"the head cannot look ahead, got a range of {lower:.3g} to {upper:.3g} rad; "
                    "expected 0 in it: name other joints as head, or leave the key out",
                )
        pan, tilt = (self._skeleton.joints.index(name) for name in self._roles.head)
        if pan not in self._skeleton.chain(tilt) and tilt not in self._skeleton.chain(pan):
            raise KeyMistake(
                f"head: joints {self._roles.head[0]!r} and {self._roles.head[1]!r} move different "
                "parts; expected a pan and a tilt joint of one head"
            )

    def shoulders(self) -> None:
        """Shoulder joints must pitch, and move the arm of their side."""
        both = self._roles.shoulders
        if both is None:
            return
        for name in both:
            self._require_axis("shoulders: joint", name, "pitch", 1)
        sides = [self._skeleton.com_below(self._skeleton.joints.index(name))[1] for name in both]
        if not sides[0] > 0.0 > sides[1]:
            exchanged = ": left and right are exchanged" if sides[0] < 0.0 < sides[1] else ""
            raise KeyMistake(
                f"shoulders: joints {both[0]!r} and {both[1]!r} do not move a left and a right "
                f"arm, got masses {sides[0]:.2f} and {sides[1]:.2f} m to the left of the "
                f"base{exchanged}; expected the left shoulder first"
            )

    def camera(self) -> None:
        """The camera must move with the head or the trunk, near the robot."""
        model, camera = self._model, self._description.camera
        if camera is None:
            return
        if isinstance(camera, str):
            body = model.body(int(model.cam_bodyid[model.camera(camera).id])).name
        else:
            body, leg = camera.body, float(np.linalg.norm(self._hips_above_feet[0]))
            distance = float(np.linalg.norm(camera.position))
            if distance > MAX_CAMERA * leg:
                raise KeyMistake(
                    f"camera.position: far from the body, got {distance:.2f} m; expected at most "
                    f"{MAX_CAMERA * leg:.2f}, twice the length of a leg"
                )
        if body not in self._skeleton.group:
            raise KeyMistake(
                f"camera: body {body!r} is not part of the robot; expected one that is"
            )
        above = self._skeleton.chain(self._skeleton.group[body])
        limbs = {name for leg in self._roles.legs for name in leg} | {
            *(self._roles.shoulders or ())
        }
        if moving := [n for j in above if (n := self._skeleton.joints[j]) in limbs]:
            raise KeyMistake(
                f"camera: body {body!r} moves with joint {moving[0]!r} of a leg or an arm; "
                "expected a camera on head or trunk"
            )

    def _require_axis(self, key: str, name: str, expected: str, axis: int) -> None:
        if any(name in leg for leg in self._roles.legs):
            raise KeyMistake(f"{key} {name!r} belongs to a leg; expected a joint above the legs")
        joint = self._skeleton.joints.index(name)
        got = self._skeleton.axes[joint]
        fits = self._skeleton.is_pitch if axis == 1 else self._skeleton.is_yaw
        if not fits(joint):
            unit = ("(1, 0, 0)", "(0, 1, 0)", "(0, 0, 1)")[axis]
            raise KeyMistake(
                f"{key} {name!r} does not {expected}, got the axis {_text(got)} in the base; "
                f"expected {unit} or its opposite: name the joint that does, or leave the key out"
            )

    def _zero(self, joint: int) -> float:
        return self._description.zero.get(self._skeleton.joints[joint], 0.0)


def _about_left(skeleton: Skeleton, joint: int) -> tuple[float, float]:
    """Return the range of a pitching joint about the left axis [rad]."""
    lower, upper = skeleton.ranges[joint]
    if skeleton.axes[joint, 1] < 0.0:
        lower, upper = -upper, -lower
    return float(lower), float(upper)


def _bend(skeleton: Skeleton, leg: Sequence[int]) -> float:
    """Return the direction in which the ranges bend a knee about the left axis: 1, -1 or 0."""
    pitching = [j for j in leg if skeleton.is_pitch(j)]
    if len(pitching) != len(PITCHING):
        return 0.0
    lower, upper = _about_left(skeleton, pitching[1])
    return 0.0 if upper == -lower else float(np.sign(upper + lower))


def _text(direction: Array) -> str:
    unit = direction / np.linalg.norm(direction)
    return f"({', '.join(f'{value + 0.0:.2f}' for value in unit)})"
