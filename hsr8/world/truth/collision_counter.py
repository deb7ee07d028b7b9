"""Collision counter: contacts with one obstacle are one collision, however long they last."""

from dataclasses import replace

from hsr8.world.truth.truth import Contact

EPISODE_GAP = 0.5  # time without contact after which a contact is a new collision [s]


class CollisionCounter:
    """Groups contacts into collisions.

    Attributes:
        collisions: first contact of each; `closing` if any simultaneous contact was closing.
    """

    def __init__(self) -> None:
        self._last_contact: dict[int, float] = {}
        self.collisions: list[Contact] = []

    def add(self, time: float, contacts: tuple[Contact, ...]) -> list[Contact]:
        """Add the contacts of one record at `time` [s] and return the collisions that begin."""
        count = len(self.collisions)
        for obstacle in sorted({contact.obstacle for contact in contacts}):
            last = self._last_contact.get(obstacle)
            self._last_contact[obstacle] = time
            if last is not None and time - last < EPISODE_GAP - 1e-9:
                continue
            touching = [c for c in contacts if c.obstacle == obstacle]
            closing = any(c.closing for c in touching)
            self.collisions.append(replace(touching[0], closing=closing))
        return self.collisions[count:]
