"""Contacts of the robot with obstacles and beacons, of its feet with the floor, from the truth."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.clearance_kernel import nearest
from hsr8.world.index import ModelIndex
from hsr8.world.layout import Layout
from hsr8.world.truth import Contact

Array = NDArray[np.float64]

CLOSING_SPEED = 0.02  # the robot closes a gap when it moves into it faster than this [m/s]
NEAR = 0.5  # clearance is computed exactly below this distance between centres [m]


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
        self._bounds = np.zeros(len(self._spheres))
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

    def clearance(self, data: mujoco.MjData, robot: Array) -> float:
        """Distance [m] from the body to the nearest obstacle or beacon; infinite without any."""
        index, bounds = self._index, self._bounds
        if not self._parts:
            return float("inf")
        gap, number = nearest(
            data.geom_xpos,
            robot,
            self._axes,
            self._sizes,
            index.robot_geoms,
            self._spheres,
            bounds,
        )
        if gap > NEAR:
            return gap
        model, parts, fromto = self._model, self._parts[number], self._fromto
        least = NEAR
        # No gap is less than its bound: most geoms need no closer look.
        for bound, geom in sorted(zip(bounds.tolist(), self._robot_geoms, strict=True)):
            if bound >= least:
                break
            for part in parts:
                gap = mujoco.mj_geomDistance(model, data, geom, part, NEAR, fromto)
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
