"""Joints of a URDF robot: the legs, and the joints that are held because no servo moves them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import inf, pi

from hsr8.errors import ModelError
from hsr8.robots.description import RobotDescription
from hsr8.robots.key_mistake import KeyMistake, require_name
from hsr8.robots.posture import clip_to_range
from hsr8.robots.roles import Leg
from hsr8.robots.urdf_elements import TURNING, Joint
from hsr8.robots.urdf_file import Urdf
from hsr8.robots.urdf_tree import Tree

MAX_EFFORT = 1e4  # a larger number is a placeholder [N m]
MAX_SPEED = 1e3  # [rad/s]


@dataclass(frozen=True, slots=True)
class Joints:
    """Joints of a robot by role.

    Attributes:
        tree: links, and the joints that are held.
        legs: six joints of the left and the right leg, hip first.
        notes: one line per derived fact.
    """

    tree: Tree
    legs: tuple[Leg, Leg]
    notes: tuple[str, ...]

    @property
    def moving(self) -> list[Joint]:
        """Joints that the model has, in the order of the file."""
        return [joint for joint in self.tree.urdf.joints.values() if self.tree.moves(joint)]

    @property
    def names(self) -> list[str]:
        """Names of the moving joints."""
        return [joint.name for joint in self.moving]


def stated(value: float, limit: float) -> bool:
    """Return whether a maximum effort or speed is a real limit, not a placeholder."""
    return 0.0 < value <= limit


def sort_joints(urdf: Urdf, description: RobotDescription, posture: Mapping[str, float]) -> Joints:
    """Find the legs and hold every joint that a servo cannot move.

    Held are: joints that mimic another, prismatic joints, those with an effort of zero or a range
    of zero, those that move no mass, and those of the key ``rigid``. Joints of legs, head and
    shoulders are exempt from the rule of the effort, because many files state none.

    Raises:
        KeyMistake: a foot is not a link, a leg has fewer than six joints, the legs share joints,
            or a joint of head or shoulders does not move.
    """
    for side, foot in zip(("left", "right"), description.feet, strict=True):
        require_name(f"feet: {side} foot", "link", foot, list(urdf.links))
    roles = {*(description.head or ()), *(description.shoulders or ())}
    exempt = roles | set(description.effort)
    reasons = _reasons(urdf, description, exempt)
    legs = [_leg(urdf, reasons, foot) for foot in description.feet]
    if min(map(len, legs)) < 6:
        powered = {name: reason for name, reason in reasons.items() if reason != "zero effort"}
        legs = [_leg(urdf, powered, foot) for foot in description.feet]
        exempt |= {*legs[0], *legs[1]}
        reasons = _reasons(urdf, description, exempt)
    for foot, leg in zip(description.feet, legs, strict=True):
        if len(leg) < 6:
            path = Tree(urdf, {}).path(foot)
            held = [f"{j.name}: {reasons[j.name]}" for j in path if j.name in reasons]
            extra = f" and {len(held)} that are held ({', '.join(held)})" if held else ""
            raise KeyMistake(
                f"feet: leg of '{foot}': {len(leg)} joints{extra}, got "
                f"{', '.join(leg) or 'none'}; expected six driven joints between base and foot"
            )
    common = [name for name in legs[0] if name in legs[1]]
    if common:
        raise KeyMistake(
            f"feet: the legs share {len(common)} joints, got {', '.join(common)}; "
            "expected six separate joints above each foot: name the last link of each leg"
        )
    for key in ("head", "shoulders"):
        for name in getattr(description, key) or ():
            if name in reasons:
                raise KeyMistake(
                    f"{key}: joint '{name}' cannot move: {reasons[name]}; expected a driven "
                    "joint: leave the key out"
                )
    angles = {name: _held_angle(urdf, name, posture) for name in reasons}
    return Joints(Tree(urdf, angles), (_six(legs[0]), _six(legs[1])), _notes(reasons))


def joint_range(joint: Joint) -> tuple[float, float]:
    """Lower and upper limit, one turn for a continuous joint [rad]."""
    return (-pi, pi) if joint.range[1] == inf else joint.range


def immovable(urdf: Urdf) -> list[str]:
    """Joints that cannot move, whatever the description states."""
    description = RobotDescription(model=str(urdf.file), feet=("left", "right"))
    return list(_reasons(urdf, description, set(urdf.joints)))


def _reasons(urdf: Urdf, description: RobotDescription, exempt: set[str]) -> dict[str, str]:
    """Reason of every joint that is held."""
    rules: dict[str, Callable[[Joint], bool]] = {
        "stated rigid": lambda joint: joint.name in description.rigid,
        "mimics a joint": lambda joint: joint.mimic is not None,
        "prismatic": lambda joint: joint.type == "prismatic",
        "range of zero": lambda joint: joint.range[0] == joint.range[1],
        "zero effort": lambda joint: joint.effort == 0.0 and joint.name not in exempt,
        "moves no mass": lambda joint: not _moves_mass(urdf, joint),
    }
    reasons = {}
    for joint in urdf.joints.values():
        reason = next((text for text, rule in rules.items() if rule(joint)), None)
        if reason is not None and joint.type in (*TURNING, "prismatic"):
            reasons[joint.name] = reason
    return reasons


def _moves_mass(urdf: Urdf, joint: Joint) -> bool:
    inertial = urdf.links[joint.child].inertial
    return (inertial is not None and inertial.mass > 0.0) or any(
        _moves_mass(urdf, below) for below in urdf.below(joint.child)
    )


def _leg(urdf: Urdf, held: Mapping[str, object], foot: str) -> list[str]:
    """Last six moving joints above a foot, hip first; fewer where the chain ends."""
    return Tree(urdf, dict.fromkeys(held, 0.0)).moving_path(foot)[-6:]


def _six(leg: list[str]) -> Leg:
    a, b, c, d, e, f = leg
    return a, b, c, d, e, f


def _held_angle(urdf: Urdf, name: str, posture: Mapping[str, float], depth: int = 0) -> float:
    """Angle of a held joint: of the posture, else by the mimicked joint, else near zero."""
    joint = urdf.joints[name]
    angle = posture.get(name)
    if angle is None and joint.mimic is not None:
        leader, multiplier, offset = joint.mimic
        if leader not in urdf.joints or depth > len(urdf.joints):
            raise ModelError(
                f"{urdf.file}: joint '{name}': mimic, got '{leader}'; expected another joint of "
                "the file"
            )
        angle = multiplier * _held_angle(urdf, leader, posture, depth + 1) + offset
    return clip_to_range(angle or 0.0, *joint.range)


def _notes(reasons: Mapping[str, str]) -> tuple[str, ...]:
    by_reason: dict[str, list[str]] = {}
    for name, reason in reasons.items():
        by_reason.setdefault(reason, []).append(name)
    return tuple(
        f"{len(names)} joints held ({reason}): {', '.join(names[:6])}"
        + (" ..." if len(names) > 6 else "")
        for reason, names in by_reason.items()
    )
