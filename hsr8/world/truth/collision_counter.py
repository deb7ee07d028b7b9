"""Contacts counted as people count them: one touch is one collision, however long it lasts."""

from dataclasses import dataclass

from hsr8.world.truth.truth import Contact

EPISODE_GAP = 0.5  # a contact after a pause as long as this is a new collision [s]


@dataclass(frozen=True, slots=True)
class Collision:
    """One contact episode with one obstacle or beacon.

    Attributes:
        time: when it began [s].
        obstacle: number of what was touched, see `Contact`.
        name: of what was touched, in words.
        moving: whether that moves.
        robot_geom: geom of the robot that touched it.
        closing: the robot's own motion closed the gap when it began.
    """

    time: float
    obstacle: int
    name: str
    moving: bool
    robot_geom: str
    closing: bool


class CollisionCounter:
    """Groups contacts into collisions."""

    def __init__(self) -> None:
        self._touched_at: dict[int, float] = {}
        self.collisions: list[Collision] = []

    def add(self, time: float, contacts: tuple[Contact, ...]) -> list[Collision]:
        """Take the contacts of one record; several geoms touching one obstacle are one.

        Returns:
            The collisions that begin with it.
        """
        known = len(self.collisions)
        for obstacle in sorted({contact.obstacle for contact in contacts}):
            before = self._touched_at.get(obstacle)
            self._touched_at[obstacle] = time
            if before is not None and time - before < EPISODE_GAP - 1e-9:
                continue
            touching = [c for c in contacts if c.obstacle == obstacle]
            self.collisions.append(
                Collision(
                    time=time,
                    obstacle=obstacle,
                    name=touching[0].name,
                    moving=touching[0].moving,
                    robot_geom=touching[0].robot_geom,
                    closing=any(c.closing for c in touching),
                )
            )
        return self.collisions[known:]
