"""Self-collisions of a robot in its ready posture."""

import mujoco

from hsr8.errors import ModelError
from hsr8.robots.skeleton import Posed

TOUCHING = -5e-4  # distance of shapes that overlap [m]
NEIGHBOURS = 3  # joints between links whose shapes may overlap by the maker's choice


class SelfCollision(ModelError):
    """Overlap of links in the ready posture."""


def exclude_neighbours(spec: mujoco.MjSpec, ready: Posed, source: str) -> list[str]:
    """Exclude overlapping links close to each other from contact, and refuse other overlaps.

    Shapes of links around one joint overlap in many files. Arms in the trunk, or legs in each
    other, mean another posture.

    Args:
        spec: of the robot, changed in place.
        ready: robot in its ready posture, above the floor.
        source: named in errors.

    Returns:
        Notes, a line each.

    Raises:
        SelfCollision: links far from each other overlap.
    """
    model, notes = ready.model, []
    overlaps: dict[tuple[int, int], float] = {}
    for contact in ready.data.contact[: ready.data.ncon]:
        one, other = sorted(int(model.geom_bodyid[geom]) for geom in contact.geom)
        if contact.dist < TOUCHING:
            overlaps[one, other] = min(float(contact.dist), overlaps.get((one, other), 0.0))
    for (one, other), distance in overlaps.items():
        names = model.body(one).name, model.body(other).name
        if _joints_between(model, one, other) > NEIGHBOURS:
            raise SelfCollision(
                f"{source}: ready posture: {names[0]!r} and {names[1]!r} overlap by "
                f"{-1e3 * distance:.1f} mm; expected a posture without self-collision: state "
                "angles of the arms in posture, or add <exclude> for the two bodies to <contact>"
            )
        spec.add_exclude(bodyname1=names[0], bodyname2=names[1])
        notes.append(f"overlapping neighbours {names[0]!r} and {names[1]!r} do not collide")
    return notes


def _joints_between(model: mujoco.MjModel, one: int, other: int) -> int:
    """Return the number of joints between two bodies."""
    above: dict[int, int] = {}
    count, body = 0, one
    while body > 0:
        above[body] = count
        count += int(model.body_jntnum[body])
        body = int(model.body_parentid[body])
    count, body = 0, other
    while body not in above:
        count += int(model.body_jntnum[body])
        body = int(model.body_parentid[body])
    return count + above[body]
