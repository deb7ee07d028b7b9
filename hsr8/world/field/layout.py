"""Layout of a world: obstacles, beacons, start and waypoints."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.fault import Bump, Fault, MoverAppears
from hsr8.scenario.track import AWAY
from hsr8.scenario.world import World
from hsr8.world.field.motion import ALWAYS, SAME_TIME, Interval, MotionLaw, Movers, Point
from vision.sizes import Sizes

Array = NDArray[np.float64]

SIZES = Sizes()  # in a world of scale 1
BEACON_OFFSET = 0.3  # of the beacons from the border of the field, at that scale [m]
BEACON_COLORS = ("yellow", "cyan", "magenta")


@dataclass(frozen=True, slots=True)
class Obstacle:
    """Upright cylinder on the floor.

    Attributes:
        position: axis in W, of a mover at time zero [m].
        radius: radius of the cylinder [m].
        height: height of the cylinder [m].
        color: name of the colour class.
        motion: motion law of a mover; None of a static obstacle.
        yields: whether a mover waits for the robot.
        present: begin and end of its presence, outside of which a mover is far away [s].
    """

    position: Point
    radius: float
    height: float
    color: str
    motion: MotionLaw | None = None
    yields: bool = False
    present: Interval = ALWAYS


@dataclass(frozen=True, slots=True)
class Reactions:
    """Reactions of the movers to the robot and to one another.

    Attributes:
        crowd: whether movers avoid one another, and static obstacles, by ORCA.
        sees_robot: whether such a crowd avoids the robot, too.
        robot_radius: radius of the robot [m].
        time_scale: duration of an action relative to that of HSR-VIII [1].
    """

    crowd: bool = False
    sees_robot: bool = True
    robot_radius: float = 0.0
    time_scale: float = 1.0


@dataclass(frozen=True, slots=True)
class Beacon:
    """Beacon: two-colour landmark at a known position.

    Attributes:
        name: ``top/bottom``.
        position: axis in W [m].
        top: colour of the upper half.
        bottom: colour of the lower half.
        radius: radius of the cylinder [m].
        height: height of the cylinder [m].
        known: position on the robot's map, if it differs [m].
    """

    name: str
    position: Point
    top: str
    bottom: str
    radius: float = SIZES.beacon_radius
    height: float = SIZES.beacon_height
    known: Point | None = None

    @property
    def believed(self) -> Point:
        """Position of the axis on the robot's map in W [m]."""
        return self.position if self.known is None else self.known


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """World of one run.

    Attributes:
        field_size: extent of the field along x and y, centred on the origin of W [m].
        obstacles: static obstacles, then movers.
        beacons: landmarks.
        start: x, y, heading of the robot at time zero [m, m, rad].
        waypoints: points to pass in W (n, 2) [m]; empty without a destination.
        goal_heading: required heading at the last waypoint [rad]; None for any.
        endless: the first waypoint follows the last one.
        bumps: low discs on the floor (faults).
        sizes: sizes of obstacles and beacons, which the robot knows.
        scale: size of drawings and distances relative to those for HSR-VIII [1].
        reactions: reactions of the movers.
    """

    field_size: Point
    obstacles: tuple[Obstacle, ...]
    beacons: tuple[Beacon, ...]
    start: tuple[float, float, float]
    waypoints: Array
    goal_heading: float | None
    endless: bool
    bumps: tuple[Bump, ...] = ()
    sizes: Sizes = SIZES
    scale: float = 1.0
    reactions: Reactions = Reactions()

    @property
    def static(self) -> tuple[Obstacle, ...]:
        """Obstacles without motion."""
        return tuple(o for o in self.obstacles if o.motion is None)

    @property
    def movers(self) -> tuple[Obstacle, ...]:
        """Obstacles with a motion law."""
        return tuple(o for o in self.obstacles if o.motion is not None)

    def motion(self) -> Movers:
        """Return the motion laws of all movers."""
        movers = [(o.motion, o.present) for o in self.obstacles if o.motion is not None]
        return Movers([m for m, _ in movers], [p for _, p in movers], AWAY * self.scale)


def sizes_of(world: World) -> Sizes:
    """Return the sizes of the obstacles and beacons that a world may have."""
    placed = (*world.obstacle, *world.wall, *world.mover)
    radii = [*world.radius, *(cylinder.radius for cylinder in placed)]
    if world.circle.n:
        radii.append(world.circle.radius)
    low, high = SIZES.obstacle_height
    return Sizes(
        obstacle_height=world.height or (low * world.scale, high * world.scale),
        obstacle_radius=(min(radii), max(radii)),
        beacon_height=SIZES.beacon_height * world.scale,
        beacon_radius=SIZES.beacon_radius * world.scale,
    )


def beacons_of(world: World, sizes: Sizes) -> tuple[Beacon, ...]:
    """Return the beacons of a world."""
    if not world.beacons:
        return ()
    beacons = standard_beacons(world.size, sizes, world.scale)
    return with_first_moved(beacons, world.beacon_displacement, world.size)


def standard_beacons(
    field_size: Point, sizes: Sizes = SIZES, scale: float = 1.0
) -> tuple[Beacon, ...]:
    """Return six beacons around a field, one for every ordered pair of the beacon colours.

    They are on the rectangle `BEACON_OFFSET` times `scale` outside the border, 60 deg apart as seen
    from its centre, so that neighbours never have the same two colours.
    """
    half = 0.5 * np.asarray(field_size, dtype=float) + BEACON_OFFSET * scale
    y, c, m = BEACON_COLORS
    pairs = ((y, c), (c, m), (m, y), (c, y), (m, c), (y, m))
    beacons = []
    for k, (top, bottom) in enumerate(pairs):
        angle = np.pi / 6.0 + k * np.pi / 3.0
        unit = np.array([np.cos(angle), np.sin(angle)])
        corner = unit * np.min(half / np.maximum(np.abs(unit), 1e-9))
        x, y_ = (scale * (corner / scale).round(3)).tolist()
        beacons.append(
            Beacon(
                f"{top}/{bottom}",
                (x + 0.0, y_ + 0.0),
                top,
                bottom,
                radius=sizes.beacon_radius,
                height=sizes.beacon_height,
            )
        )
    return tuple(beacons)


def with_first_moved(
    beacons: tuple[Beacon, ...], distance: float, field_size: Point
) -> tuple[Beacon, ...]:
    """Return the beacons with the first one moved along the border, counterclockwise.

    Args:
        beacons: beacons of a field.
        distance: distance of the motion [m].
        field_size: extent of the field along x and y [m].
    """
    if distance == 0.0:
        return beacons
    first = beacons[0]
    x, y = first.position
    if x > 0.5 * field_size[0]:  # in front of the field
        y += distance
    else:  # to its left
        x -= distance
    return (replace(first, position=(x, y), known=first.position), *beacons[1:])


def with_faults(layout: Layout, faults: Sequence[Fault]) -> Layout:
    """Return `layout` with the appearing movers and bumps of `faults`."""
    obstacles = list(layout.obstacles)
    first = len(layout.static)
    for fault in faults:
        if isinstance(fault, MoverAppears):
            mover = obstacles[first + fault.mover]
            end = inf if fault.end is None else fault.end
            x, y = mover.position
            if fault.begin > SAME_TIME:
                x += AWAY * layout.scale
            present = (fault.begin, end)
            obstacles[first + fault.mover] = replace(mover, position=(x, y), present=present)
    bumps = tuple(fault for fault in faults if isinstance(fault, Bump))
    return replace(layout, obstacles=tuple(obstacles), bumps=bumps) if faults else layout
