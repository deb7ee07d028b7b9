"""Contacts of the robot with obstacles and beacons, of its feet with the floor, from the truth."""

from math import inf

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.field.layout import Layout
from hsr8.world.model.index import ModelIndex
from hsr8.world.truth.clearance_kernel import least_gaps
from hsr8.world.truth.truth import Contact

Array = NDArray[np.float64]

CLOSING_SPEED = 0.02  # the robot closes a gap when it moves into it faster than this [m/s]
FAR = 100.0  # no clearance is larger [m]


class ContactWatch:
    """Collects what the robot touched between two records."""

    def __init__(self, model: mujoco.MjModel, index: ModelIndex, layout: Layout) -> None:
        self._model = model
        self._index = index
        static = len(layout.static)
        self._things = [
            *((f"obstacle {number}", False) for number in range(static)),
            *((f"mover {number}", True) for number in range(static, len(layout.obstacles))),
            *((f"beacon {beacon.name}", False) for beacon in layout.beacons),
        ]
        self._force = np.zeros(6)
        self._fromto = np.zeros(6)
        ground = (index.floor, *index.bumps)
        self._ground = [geom in ground for geom in range(model.ngeom)]
        soles = index.foot_geoms
        self._side = [soles.index(geom) if geom in soles else -1 for geom in range(model.ngeom)]
        self._seen: dict[tuple[int, int], Contact] = {}
        # All parts of a thing share one axis and one radius: the first stands for it from above.
        self._axes = np.concatenate([index.obstacle_geoms, index.beacon_geoms[:, 0]])
        self._parts: list[list[int]] = [
            *index.obstacle_geoms[:, None].tolist(),
            *index.beacon_geoms.tolist(),
        ]
        self._first_obstacle = int(min(self._axes, default=model.ngeom))
        self._robot_geoms: list[int] = index.robot_geoms.tolist()
        self._obstacle_of: list[int] = index.obstacle_of_geom.tolist()
        self._spheres = model.geom_rbound[index.robot_geoms].copy()
        self._sizes = model.geom_size[self._axes, 0].copy()

    def watch(self, data: mujoco.MjData) -> None:
        """Note the present contacts with obstacles and beacons."""
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
            if key in self._seen and self._seen[key].force >= force:
                continue
            name, moving = self._things[obstacle]
            towards = data.geom_xpos[self._axes[obstacle]][:2] - data.geom_xpos[geom][:2]
            velocity = data.qvel[self._index.root_dof : self._index.root_dof + 2]
            distance = float(np.hypot(*towards))
            self._seen[key] = Contact(
                obstacle=obstacle,
                name=name,
                moving=moving,
                robot_geom=self._model.geom(geom).name,
                force=force,
                closing=float(velocity @ towards) > CLOSING_SPEED * distance,
            )

    def take(self) -> tuple[Contact, ...]:
        """Contacts since the last call, by obstacle and geom; forgets them."""
        contacts = tuple(self._seen[key] for key in sorted(self._seen))
        self._seen.clear()
        return contacts

    def clearance(self, data: mujoco.MjData) -> float:
        """Distance [m] from the body to the nearest obstacle or beacon; infinite without any."""
        geoms = self._index.robot_geoms
        if not self._parts or not len(geoms):
            return inf
        bounds = least_gaps(data.geom_xpos, self._axes, self._sizes, geoms, self._spheres).ravel()
        least = self._distance(data, int(bounds.argmin()), FAR)
        # No gap is less than its bound: few pairs need a closer look.
        near = np.flatnonzero(bounds < least)
        for pair in near[np.argsort(bounds[near])].tolist():
            if bounds[pair] >= least:
                break
            least = min(least, self._distance(data, pair, max(least, 0.0)))
        return least

    def _distance(self, data: mujoco.MjData, pair: int, limit: float) -> float:
        """Distance of an obstacle from a geom of the robot, `limit` at most [m].

        `pair` is obstacle * n_geoms + geom.
        """
        number, geom = divmod(pair, len(self._robot_geoms))
        own, least = self._robot_geoms[geom], limit
        for part in self._parts[number]:
            gap = mujoco.mj_geomDistance(self._model, data, own, part, limit, self._fromto)
            least = min(least, gap)
        return least

    def feet(self, data: mujoco.MjData) -> tuple[Array, Array]:
        """Normal force under each foot (2,) [N] and the centre of pressure (2,) [m]."""
        load = [0.0, 0.0]
        x = y = 0.0
        contact, ground, side = data.contact, self._ground, self._side
        places = contact.pos.tolist()
        for i, (one, other) in enumerate(contact.geom.tolist()):
            foot = side[other] if ground[one] else side[one] if ground[other] else -1
            if foot < 0:
                continue
            mujoco.mj_contactForce(self._model, data, i, self._force)
            force = float(self._force[0])
            load[foot] += force
            x += force * places[i][0]
            y += force * places[i][1]
        total = load[0] + load[1]
        pressure = np.array([x, y]) / total if total > 0.0 else np.full(2, np.nan)
        return np.array(load), pressure
