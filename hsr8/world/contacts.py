"""Contacts of the robot with obstacles and of its feet with the floor, from the truth."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.index import ModelIndex
from hsr8.world.truth import Contact

Array = NDArray[np.float64]

CLOSING_SPEED = 0.02  # the robot closes a gap when it moves into it faster than this [m/s]
NEAR = 0.5  # clearance is computed exactly below this distance between centres [m]


class ContactWatch:
    """Collects what the robot touched between two records."""

    def __init__(self, model: mujoco.MjModel, index: ModelIndex, n_static: int) -> None:
        self._model = model
        self._index = index
        self._n_static = n_static
        self._force = np.zeros(6)
        self._fromto = np.zeros(6)
        self._seen: dict[tuple[int, int], Contact] = {}
        self._is_foot = np.zeros(model.ngeom, dtype=bool)
        self._is_foot[list(index.foot_geoms)] = True

    def watch(self, data: mujoco.MjData) -> None:
        """Note the present contacts with obstacles."""
        n = data.ncon
        if n == 0:
            return
        pairs = data.contact.geom
        obstacles = self._index.obstacle_of_geom[pairs]
        for i in np.flatnonzero(obstacles.max(axis=1) >= 0).tolist():
            first, second = obstacles[i].tolist()
            obstacle = max(first, second)
            geom = int(pairs[i][1] if first >= 0 else pairs[i][0])
            key = (obstacle, geom)
            mujoco.mj_contactForce(self._model, data, i, self._force)
            force = float(self._force[0])
            if key in self._seen and self._seen[key].force >= force:
                continue
            towards = (
                data.geom_xpos[self._index.obstacle_geoms[obstacle]][:2] - data.geom_xpos[geom][:2]
            )
            velocity = data.qvel[self._index.root_dof : self._index.root_dof + 2]
            distance = float(np.hypot(*towards))
            self._seen[key] = Contact(
                obstacle=obstacle,
                moving=obstacle >= self._n_static,
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
        """Distance [m] from the body to the nearest obstacle; infinite without obstacles."""
        geoms = self._index.obstacle_geoms
        if len(geoms) == 0:
            return float("inf")
        gaps = (
            np.hypot(*(data.geom_xpos[geoms, :2] - robot[:2]).T) - self._model.geom_size[geoms, 0]
        )
        nearest = int(np.argmin(gaps))
        if gaps[nearest] > NEAR:
            return float(gaps[nearest])
        return float(
            min(
                mujoco.mj_geomDistance(
                    self._model, data, int(g), int(geoms[nearest]), NEAR, self._fromto
                )
                for g in self._index.robot_geoms
            )
        )

    def feet(self, data: mujoco.MjData) -> tuple[Array, Array]:
        """Normal force under each foot (2,) [N] and the centre of pressure (2,) [m]."""
        load = np.zeros(2)
        moment = np.zeros(2)
        pairs = data.contact.geom[: data.ncon]
        on_foot = self._is_foot[pairs].any(axis=1) & (pairs == self._index.floor).any(axis=1)
        for i in np.flatnonzero(on_foot).tolist():
            mujoco.mj_contactForce(self._model, data, i, self._force)
            side = 0 if self._index.foot_geoms[0] in pairs[i] else 1
            load[side] += self._force[0]
            moment += self._force[0] * data.contact.pos[i][:2]
        total = load.sum()
        return load, moment / total if total > 0.0 else np.full(2, np.nan)
