"""Ground truth of one instant and counters of falls and collisions, for recorder and metrics."""

from dataclasses import dataclass, replace
from math import degrees, hypot

import numpy as np
from numpy.typing import NDArray

from compilation.value import value

Array = NDArray[np.float64]

EPISODE_GAP = 0.5  # time without contact after which a contact is a new collision [s]
RECOVERY_TIME = 1.0  # upright time after which a fall is over [s]


@dataclass(frozen=True, slots=True)
class Contact:
    """Contact of the robot with an obstacle or a beacon.

    Attributes:
        obstacle: number in the layout: obstacles, then beacons.
        name: name of the obstacle or beacon, for people.
        moving: whether it is a mover.
        robot_geom: name of the geom of the robot, or of its body.
        force: normal force [N].
        closing: whether the motion of the robot closed the gap.
    """

    obstacle: int
    name: str
    moving: bool
    robot_geom: str
    force: float
    closing: bool


@dataclass(frozen=True, slots=True)
class ActivePush:
    """Push that acts on the robot.

    Attributes:
        number: number of the push in its run.
        begin: start of the push [s].
        duration: total [s].
        body: name of the pushed body.
        direction: direction from the heading of the robot at the start, counter-clockwise [rad].
        point: point of action of the force in W (3,) [m].
        force: force in W (3,) [N].
    """

    number: int
    begin: float
    duration: float
    body: str
    direction: float
    point: Array
    force: Array

    @property
    def impulse(self) -> float:
        """Force times duration [N s]."""
        return hypot(*self.force.tolist()) * self.duration

    def text(self) -> str:
        """Return a description for people."""
        return (
            f"{self.impulse:.2f} N s in {1000 * self.duration:.0f} ms on {self.body}, to "
            f"{degrees(self.direction):.0f} deg from forward"
        )


@value
class Truth:
    """State of the world at one instant.

    Attributes:
        time: simulated time [s].
        qpos: generalised position of the robot, MuJoCo order (nq,).
        robot: x, y, heading of the robot frame R in W (3,) [m, m, rad].
        obstacle_positions: axes of all obstacles, layout order (n, 2) [m].
        obstacle_velocities: (n, 2) [m/s].
        mover_clocks: time of each mover on its lane, none where all follow time (m,) [s].
        contacts: since the previous record.
        clearance: distance of the robot to the nearest obstacle or beacon [m].
        joint_torque: (n,) [N m].
        foot_force: true normal force under the left and right foot (2,) [N].
        zmp: centre of pressure under both feet in W (2,) [m], NaN when airborne.
        fallen: whether the robot has fallen.
        pushes: active since the previous record.
    """

    time: float
    qpos: Array
    robot: Array
    obstacle_positions: Array
    obstacle_velocities: Array
    mover_clocks: Array
    contacts: tuple[Contact, ...]
    clearance: float
    joint_torque: Array
    foot_force: Array
    zmp: Array
    fallen: bool
    pushes: tuple[ActivePush, ...] = ()


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
