"""URDF file as a tree of links, checked for the mistakes that a robot cannot be made of."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree import ElementTree

from hsr8.errors import ModelError
from hsr8.robots.urdf_elements import TURNING, ElementReader, Joint, Link


@dataclass(frozen=True, slots=True)
class Urdf:
    """Robot of a URDF file: a tree of links.

    Attributes:
        file: the file.
        links: by name, in the order of the file.
        joints: by name, in the order of the file.
        above: joint above each link but the root.
        root: link without a joint above it.
    """

    file: Path
    links: dict[str, Link]
    joints: dict[str, Joint]
    above: dict[str, Joint]
    root: str

    def below(self, link: str) -> list[Joint]:
        """Joints whose parent is a link, in the order of the file."""
        return [joint for joint in self.joints.values() if joint.parent == link]

    def with_ranges(self, ranges: Mapping[str, tuple[float, float]]) -> "Urdf":
        """Return the robot with other limits of some joints [rad]; unknown names are ignored."""
        joints = {
            name: replace(joint, range=ranges.get(name, joint.range))
            for name, joint in self.joints.items()
        }
        above = {link: joints[joint.name] for link, joint in self.above.items()}
        return replace(self, joints=joints, above=above)


def read_urdf(file: Path) -> Urdf:
    """Read a URDF file.

    A root link without mass and shapes that a floating joint carries (``world``) is left out.

    Raises:
        ModelError: the file cannot be read, is not a URDF file, a number is invalid, an inertia
            is negative, or the links do not form a tree.
    """
    try:
        robot = ElementTree.fromstring(file.read_bytes())
    except (OSError, ElementTree.ParseError) as error:
        raise ModelError(f"{file}: cannot be read: {error}; expected a URDF file") from error
    if robot.tag != "robot":
        raise ModelError(
            f"{file}: not a URDF file, got the element <{robot.tag}>; expected <robot>"
        )
    if any("xacro" in element.tag for element in robot.iter()):
        raise ModelError(f"{file}: a xacro file; expected the URDF file that `xacro` makes of it")
    read = ElementReader(file)
    colors = {m.get("name", ""): read.color(m) for m in robot.findall("material")}
    links = [read.link(element, colors) for element in robot.findall("link")]
    joints = [read.joint(element) for element in robot.findall("joint")]
    for kind, names in (("link", [x.name for x in links]), ("joint", [x.name for x in joints])):
        twice = [name for name, count in Counter(names).items() if count > 1]
        if twice:
            raise ModelError(f"{file}: {kind} '{twice[0]}' appears twice; expected unique names")
    return _tree(file, {x.name: x for x in links}, {x.name: x for x in joints})


def _tree(file: Path, links: dict[str, Link], joints: dict[str, Joint]) -> Urdf:
    above: dict[str, Joint] = {}
    for joint in joints.values():
        for end in (joint.parent, joint.child):
            if end not in links:
                raise ModelError(f"{file}: joint '{joint.name}': no link '{end}' in the file")
        if joint.child in above:
            raise ModelError(
                f"{file}: link '{joint.child}': closed chain, it is the child of the joints "
                f"'{above[joint.child].name}' and '{joint.name}'; expected one parent: remove one "
                "of the joints, a tree of links is needed"
            )
        above[joint.child] = joint
    for name in links:
        ancestors = [name]
        while ancestors[-1] in above:
            ancestors.append(above[ancestors[-1]].parent)
            if ancestors[-1] in ancestors[:-1]:
                raise ModelError(
                    f"{file}: link '{name}': closed chain, it is its own ancestor; expected a tree"
                )
    roots = [name for name in links if name not in above]
    if len(roots) != 1:
        raise ModelError(
            f"{file}: {len(roots)} root links, got {', '.join(roots[:5]) or 'none'}; expected one "
            "link without a parent, whose joints carry all others"
        )
    return _without_world(Urdf(file, links, joints, above, roots[0]))


def _without_world(urdf: Urdf) -> Urdf:
    """Leave out a root link that only anchors a floating joint; refuse other such joints."""
    root, top = urdf.links[urdf.root], [j for j in urdf.joints.values() if j.parent == urdf.root]
    empty = root.inertial is None and not root.visual and not root.collision
    if empty and len(top) == 1 and top[0].type == "floating":
        urdf = Urdf(
            urdf.file,
            {name: link for name, link in urdf.links.items() if name != urdf.root},
            {name: joint for name, joint in urdf.joints.items() if name != top[0].name},
            {name: joint for name, joint in urdf.above.items() if name != top[0].child},
            top[0].child,
        )
    for joint in urdf.joints.values():
        if joint.type not in ("fixed", "prismatic", *TURNING):
            raise ModelError(
                f"{urdf.file}: joint '{joint.name}' of type {joint.type}; expected revolute, "
                "continuous, prismatic or fixed: make it fixed, the simulator frees the base itself"
            )
    return urdf
