"""Counters of collisions and falls, each of which may last."""

from dataclasses import replace

from hsr8.world.truth.truth import Contact

EPISODE_GAP = 0.5  # time without contact after which a contact is a new collision [s]

RECOVERY_TIME = 1.0  # upright time after which a fall is over [s]


class Falls:
    """Counts the falls of a run.

    Failed attempts to get up belong to the same fall.

    Attributes:
        count: falls so far.
    """

    def __init__(self) -> None:
        self._last_fallen: float | None = None
        self.count = 0

    def add(self, time: float, *, fallen: bool) -> bool:
        """Add one record at `time` [s] and return whether a fall begins with it."""
        begins = fallen and not self.lasting(time)
        if fallen:
            self._last_fallen = time
        self.count += begins
        return begins

    def lasting(self, time: float) -> bool:
        """Return whether a fall lasts at `time` [s]."""
        return self._last_fallen is not None and time - self._last_fallen < RECOVERY_TIME


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
