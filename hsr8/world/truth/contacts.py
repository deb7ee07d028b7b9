"""True contacts of the robot with obstacles and beacons, and of its feet with the floor."""

from math import inf, sqrt

import mujoco
import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from hsr8.world.field.layout import Layout
from hsr8.world.model.index import ModelIndex
from hsr8.world.truth.truth import Contact

Array = NDArray[np.float64]

CLOSING_SPEED = 0.02  # of a robot at fault towards an obstacle, in a world of scale 1 [m/s]
MAX_CLEARANCE = 100.0  # [m]

OTHER, GROUND = -1, -2  # parts of a contact that are not feet

Ints = NDArray[np.intp]
Ints32 = NDArray[np.int32]


class ContactWatch:
    """Collects the contacts of the robot between two records.

    Args:
        model: compiled world.
        index: addresses in the model.
        layout: obstacles and beacons.
    """

    def __init__(self, model: mujoco.MjModel, index: ModelIndex, layout: Layout) -> None:
        self._model = model
        self._index = index
        self._closing_speed = CLOSING_SPEED * layout.scale
        static = len(layout.static)
        self._names = [
            *((f"obstacle {number}", False) for number in range(static)),
            *((f"mover {number}", True) for number in range(static, len(layout.obstacles))),
            *((f"beacon {beacon.name}", False) for beacon in layout.beacons),
        ]
        self._force = np.zeros(6)
        self._fromto = np.zeros(6)
        self._parts = np.full(model.ngeom, OTHER, dtype=np.intp)
        self._parts[[index.floor, *index.bumps]] = GROUND
        self._parts[list(index.foot_geoms)] = 0, 1
        self._pyramidal = model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL
        self._contacts: dict[tuple[int, int], Contact] = {}
        # All parts of an object share axis and radius: the first one represents it from above.
        self._axes = np.concatenate([index.obstacle_geoms, index.beacon_geoms[:, 0]])
        self._geoms_of: list[list[int]] = [
            *index.obstacle_geoms[:, None].tolist(),
            *index.beacon_geoms.tolist(),
        ]
        self._first_obstacle = int(min(self._axes, default=model.ngeom))
        self._robot_geoms: list[int] = index.robot_geoms.tolist()
        self._obstacle_of: list[int] = index.obstacle_of_geom.tolist()
        self._spheres = model.geom_rbound[index.robot_geoms].copy()
        self._sizes = model.geom_size[self._axes, 0].copy()

    def watch(self, data: mujoco.MjData) -> None:
        """Collect the present contacts with obstacles and beacons."""
        for i, (one, other) in enumerate(data.contact.geom.tolist()):
            if one < self._first_obstacle and other < self._first_obstacle:
                continue
            first, second = self._obstacle_of[one], self._obstacle_of[other]
            obstacle = max(first, second)
            if obstacle < 0:
                continue
            geom = other if first >= 0 else one
            key = (obstacle, geom)
            mujoco.mj_contactForce(self._model, data, i, self._force)
            force = float(self._force[0])
            if key in self._contacts and self._contacts[key].force >= force:
                continue
            name, moving = self._names[obstacle]
            towards = data.geom_xpos[self._axes[obstacle]][:2] - data.geom_xpos[geom][:2]
            velocity = data.qvel[self._index.root_dof : self._index.root_dof + 2]
            distance = float(np.hypot(*towards))
            self._contacts[key] = Contact(
                obstacle=obstacle,
                name=name,
                moving=moving,
                robot_geom=self._name(geom),
                force=force,
                closing=float(velocity @ towards) > self._closing_speed * distance,
            )

    def _name(self, geom: int) -> str:
        """Return the name of a geom, or of its body if it has none."""
        model = self._model
        name: str = model.geom(geom).name
        return name or str(model.body(int(model.geom_bodyid[geom])).name)

    def take(self) -> tuple[Contact, ...]:
        """Return and clear the contacts since the last call, by obstacle and geom."""
        contacts = tuple(self._contacts[key] for key in sorted(self._contacts))
        self._contacts.clear()
        return contacts

    def clearance(self, data: mujoco.MjData) -> float:
        """Return the distance to the nearest obstacle or beacon [m]; infinite without any."""
        if not len(self._axes):
            return inf
        bounds = gap_bounds(
            data.geom_xpos, self._axes, self._sizes, self._index.robot_geoms, self._spheres
        )
        pair, gap, limit = int(bounds.argmin()), inf, MAX_CLEARANCE
        # No gap is below its bound, so that few pairs need the exact distance.
        while bounds[pair] < gap:
            gap = min(gap, self._distance(data, pair, limit))
            bounds[pair], limit = inf, max(gap, 0.0)
            pair = int(bounds.argmin())
        return gap

    def _distance(self, data: mujoco.MjData, pair: int, limit: float) -> float:
        """Return the distance of an obstacle to a geom of the robot, up to `limit` [m].

        `pair` is obstacle * n_geoms + geom.
        """
        obstacle, number = divmod(pair, len(self._robot_geoms))
        model, geom = self._model, self._robot_geoms[number]
        gaps: list[float] = [
            mujoco.mj_geomDistance(model, data, geom, part, limit, self._fromto)
            for part in self._geoms_of[obstacle]
        ]
        return min(limit, *gaps)

    def feet(self, data: mujoco.MjData) -> tuple[Array, Array]:
        """Return the normal force under each foot (2,) [N] and the centre of pressure (2,) [m]."""
        contact = data.contact
        load, pressure = np.zeros(2), np.full(2, np.nan)
        # Copies, because MuJoCo's arrays are views of its records, with gaps.
        feet_forces(
            contact.geom.copy(),
            contact.pos.copy(),
            contact.efc_address.copy(),
            contact.dim.copy(),
            data.efc_force,
            self._parts,
            self._pyramidal,
            load,
            pressure,
        )
        return load, pressure


@compiled
def feet_forces(
    geoms: Ints32,
    positions: Array,
    addresses: Ints32,
    dimensions: Ints32,
    forces: Array,
    parts: Ints,
    pyramidal: bool,
    load: Array,
    pressure: Array,
) -> None:
    """Set the normal force under each foot and the centre of pressure.

    Args:
        geoms: geoms of each contact (n, 2).
        positions: position of each contact in W (n, 3) [m].
        addresses: address of each contact in `forces`, negative without a force (n,).
        dimensions: dimension of each contact (n,).
        forces: constraint forces of MuJoCo [N].
        parts: side of the foot of every geom, 0 or 1; `GROUND`; `OTHER` (ngeom,).
        pyramidal: whether the friction cones are pyramids, whose edges share the normal force.
        load: set to the normal force under the left and the right foot (2,) [N].
        pressure: set to the centre of pressure in W if there is a load (2,) [m].
    """
    x, y = 0.0, 0.0
    for i in range(len(geoms)):
        one, other = parts[geoms[i, 0]], parts[geoms[i, 1]]
        foot = other if one == GROUND else one if other == GROUND else OTHER
        if foot < 0 or addresses[i] < 0:
            continue
        edges = 2 * (dimensions[i] - 1) if pyramidal and dimensions[i] > 1 else 1
        force = 0.0
        for k in range(edges):
            force += forces[addresses[i] + k]
        load[foot] += force
        x += force * positions[i, 0]
        y += force * positions[i, 1]
    total = load[0] + load[1]
    if total > 0.0:
        pressure[0], pressure[1] = x / total, y / total


@compiled
def gap_bounds(
    positions: Array, obstacles: Ints, radii: Array, geoms: Ints, spheres: Array
) -> Array:
    """Return lower bounds of the gaps between n obstacles and m geoms, from above (n m,) [m].

    Args:
        positions: positions of all geoms in W (ngeom, 3) [m].
        obstacles: geom of each obstacle (n,).
        radii: radii of the obstacles (n,) [m].
        geoms: geoms of the robot (m,).
        spheres: bounding radius of each geom of the robot (m,) [m].
    """
    bounds = np.empty(len(obstacles) * len(geoms))
    for i in range(len(obstacles)):
        x, y = positions[obstacles[i], 0], positions[obstacles[i], 1]
        for k in range(len(geoms)):
            dx, dy = positions[geoms[k], 0] - x, positions[geoms[k], 1] - y
            distance = sqrt(dx * dx + dy * dy)
            bounds[i * len(geoms) + k] = distance - spheres[k] - radii[i]
    return bounds
