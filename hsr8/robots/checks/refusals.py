"""Refusal of robots that cannot walk: legs, base, head, shoulders and posture.

Every check raises one `ModelError` with the element, the reason and the remedy.
"""

from collections.abc import Sequence
from math import degrees

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.checks.mechanism import check_mechanism
from hsr8.robots.file.description import RobotDescription
from hsr8.robots.file.key_mistake import KeyMistake, at_most, joint_error
from hsr8.robots.parts.limbs import BENT, bent, foot_joint, side_vote, toe_vote
from hsr8.robots.parts.roles import Roles, present
from hsr8.robots.parts.skeleton import MirroredPair, Skeleton, mirrored_pairs, skeleton_of

Array = NDArray[np.float64]

MAX_SHIFT = 0.01  # of a mirrored joint axis, in lengths of the leg [1]
MAX_TURN = np.radians(1.0)  # of a mirrored joint axis [rad]
MAX_RANGE_DIFFERENCE = 0.1  # of mirrored limits; ranges that differ more are intersected [rad]
PITCHING = ("hip", "knee", "ankle")
MIN_FREEDOM = 0.01  # singular value of the scaled Jacobian of a bent leg, minimum over maximum [1]
MAX_ZERO = 0.5  # angle that is proposed as zero [rad]
SLACK = 1e-6  # of limits [rad]
MAX_CAMERA = 2.0  # distance of a camera from the origin of its body, in lengths of the leg [1]


def check_roles(
    model: mujoco.MjModel,
    roles: Roles,
    description: RobotDescription,
    source: str,
) -> tuple[dict[str, tuple[float, float]], list[str]]:
    """Refuse a robot that cannot walk.

    Args:
        model: compiled model.
        roles: roles of its parts.
        description: description of the robot.
        source: model file, which begins the messages about its elements.

    Returns:
        Ranges of leg joints that must be smaller to be mirror images [rad], and notes on them.

    Raises:
        KeyMistake: a key of the description is wrong.
        ModelError: an element of the model is wrong.
    """
    check_mechanism(model, roles, description, source)
    check = _Checks(model, roles, description, source)
    check.ranges()
    check.toes()
    check.pitching()
    check.knees()
    check.bending()
    ranges, notes = check.mirror()
    check.freedom()
    check.head()
    check.shoulders()
    check.camera()
    return ranges, notes


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
        self._zero = present(model, description.zero)
        self._skeleton = self._posed({})
        left, right = roles.legs
        index = self._skeleton.joints.index
        self._legs = ([index(name) for name in left], [index(name) for name in right])
        hips, feet = ([leg[end] for leg in self._legs] for end in (0, -1))
        self._hips_above_feet = self._skeleton.anchors[hips] - self._skeleton.anchors[feet]

    def _posed(self, more: dict[str, float]) -> Skeleton:
        base = self._model.body(self._roles.base).id
        return skeleton_of(self._model, base, {**self._zero, **more})

    def _range_error(self, joint: str, reason: str) -> ModelError:
        return joint_error(joint, "range", self._description, self._source, reason)

    def ranges(self) -> None:
        """Stated angles must lie within the limits; `posture` excludes legs and head."""
        robot, index = self._description, {n: k for k, n in enumerate(self._skeleton.joints)}
        leg = {name for leg in self._roles.legs for name in leg}
        for key, other in ((robot.zero, "zero"), (robot.posture, "posture")):
            for name, angle in present(self._model, key).items():
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

    def toes(self) -> None:
        """The foot must not be behind a joint of the toes."""
        skeleton = self._skeleton
        for side, leg in enumerate(self._legs):
            above = skeleton.chain(leg[-1])
            last = foot_joint(skeleton, above)
            if last < len(above) - 1:
                toe, foot = skeleton.joints[above[last + 1]], skeleton.bodies[above[last]]
                raise KeyMistake(
                    f"feet: {self._description.feet[side]!r} is behind the toe joint {toe!r}; "
                    f"expected the foot itself, {foot!r}"
                )

    def knees(self) -> None:
        """The knees must bend forward, where forward follows from the left and the right foot."""
        skeleton, feet = self._skeleton, self._description.feet
        bend = [self._bend(leg) for leg in self._legs]
        names = side_vote(*feet)
        if not max(bend) < 0 and not (max(map(abs, bend)) == 0 and names < 0):
            return
        exchanged = "left and right are exchanged; expected the left foot first"
        backward = "the knees bend backward; expected forward: such legs are not supported"
        vote = names or toe_vote(skeleton, *self._legs)
        if vote < 0:
            raise KeyMistake(f"feet: {feet[0]!r} and {feet[1]!r}: {exchanged}")
        reason = backward if vote > 0 else f"{backward}; or {exchanged}"
        raise KeyMistake(f"feet: {feet[0]!r} and {feet[1]!r}: {reason}")

    def pitching(self) -> None:
        """A leg must have three joints that pitch at zero angles."""
        for leg, names in zip(self._legs, self._roles.legs, strict=True):
            pitching = [self._skeleton.joints[j] for j in self._skeleton.pitching(leg)]
            if len(pitching) != len(PITCHING):
                got = ", ".join(pitching) or "none"
                raise KeyMistake(
                    f"feet: of the leg {names[0]!r} to {names[-1]!r}, {len(pitching)} joints pitch "
                    f"at zero angles, got {got}; expected hip, knee and ankle"
                )

    def _bend(self, leg: Sequence[int]) -> int:
        """Return how the range of a knee bends it, see `Skeleton.bend`."""
        knee = self._skeleton.pitching(leg)[1]
        sign = float(np.sign(self._skeleton.axes[knee, 1]))
        return self._skeleton.bend(leg, sign * self._zero_of(knee))

    def bending(self) -> None:
        """The ranges must include a bent leg."""
        for leg in self._legs:
            pitching = self._skeleton.pitching(leg)
            for part, joint, angle in zip(PITCHING, pitching, BENT, strict=True):
                lower, upper = self._skeleton.range_about_left(joint)
                zero = self._zero_of(joint) * np.sign(self._skeleton.axes[joint, 1])
                if not lower - SLACK <= zero + angle <= upper + SLACK:
                    name = self._skeleton.joints[joint]
                    raise self._range_error(
                        name,
                        f"the {part} cannot bend, got a range of "
                        f"{lower - zero:.2f} to {upper - zero:.2f} rad about the left axis; "
                        f"expected {angle:g} in it: state its range, if the limits of the model "
                        "are wrong",
                    )

    def mirror(self) -> tuple[dict[str, tuple[float, float]], list[str]]:
        """The right leg must be the mirror image of the left one; return their common ranges."""
        size = float(np.linalg.norm(self._hips_above_feet.mean(axis=0)))
        ranges, notes = dict[str, tuple[float, float]](), list[str]()
        for pair in mirrored_pairs(self._skeleton, *self._legs):
            left, right = (self._skeleton.joints[j] for j in (pair.left, pair.right))
            shift, turn = 1e3 * pair.distance, degrees(pair.angle)
            for wrong, reason in (
                (
                    pair.distance > MAX_SHIFT * size,
                    f"axes are {shift:.3g} mm apart; expected at most "
                    f"{at_most(1e3 * MAX_SHIFT * size)}",
                ),
                (
                    pair.angle > MAX_TURN,
                    f"axes differ by {turn:.1f} deg; expected at most {degrees(MAX_TURN):.0f}",
                ),
            ):
                if wrong:
                    raise self._range_error(
                        right,
                        f"not the mirror image of {left!r} in the plane y = 0 of the base at zero "
                        f"angles: {reason}: correct the model, or state {self._alike(pair)}",
                    )
            if pair.range > MAX_RANGE_DIFFERENCE:
                ranges |= self._common_range(pair, left, right)
                lower, upper = ranges[left]
                notes.append(
                    f"ranges of {left!r} and {right!r} differ by {pair.range:.2f} rad: the common "
                    f"part is used, {lower:.3g} to {upper:.3g} rad of {left!r}"
                )
        return ranges, notes

    def _alike(self, pair: MirroredPair) -> str:
        """Return the angle of the joint above with which a right joint mirrors the left one."""
        skeleton = self._skeleton
        (*_, above), mirror = (-1, *skeleton.chain(pair.right)[:-1]), np.array([1.0, -1.0, 1.0])
        hinge, origin = skeleton.axes[above], skeleton.anchors[above]
        now, image = skeleton.axes[pair.right], -mirror * skeleton.axes[pair.left]
        if pair.angle <= MAX_TURN:
            now, image = (
                a - origin
                for a in (skeleton.anchors[pair.right], mirror * skeleton.anchors[pair.left])
            )
        elif image @ now < 0.0:
            image = -image
        now, image = (part - (part @ hinge) * hinge for part in (now, image))
        angle = float(np.arctan2(hinge @ np.cross(now, image), now @ image))
        if above < 0 or abs(angle) < SLACK or abs(angle) > MAX_ZERO:
            return "angles at which the legs are alike as zero"
        return f"zero.{skeleton.joints[above]} = {self._zero_of(above) + angle:.3f}"

    def _common_range(
        self, pair: MirroredPair, left: str, right: str
    ) -> dict[str, tuple[float, float]]:
        """Return the common part of the ranges of two mirrored joints, by joint [rad]."""
        one, other = (self._skeleton.ranges[j] for j in (pair.left, pair.right))
        image = -one[::-1] if pair.reversed else one
        lower, upper = max(image[0], other[0]), min(image[1], other[1])
        if not lower < upper:
            key = left if left in self._description.range else right
            raise self._range_error(
                key,
                f"the mirrored ranges of {left!r} and {right!r} have nothing in common, got "
                f"{image[0]:.3g} to {image[1]:.3g} and {other[0]:.3g} to {other[1]:.3g} rad; "
                "expected equal ones: state range",
            )
        mirrored = (-upper, -lower) if pair.reversed else (lower, upper)
        return {left: mirrored, right: (lower, upper)}

    def freedom(self) -> None:
        """A bent leg must be able to move its foot in all six directions."""
        posed = self._posed(bent(self._skeleton, self._legs, self._zero))
        for leg, names in zip(self._legs, self._roles.legs, strict=True):
            arms = posed.anchors[leg[-1]] - posed.anchors[leg]
            axes, size = posed.axes[leg], float(np.linalg.norm(arms[0]))
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
            body = camera.body
            leg = float(np.linalg.norm(self._hips_above_feet[0]))
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

    def _zero_of(self, joint: int) -> float:
        return self._zero.get(self._skeleton.joints[joint], 0.0)


def _text(direction: Array) -> str:
    unit = direction / np.linalg.norm(direction)
    return f"({', '.join(f'{value + 0.0:.2f}' for value in unit)})"
