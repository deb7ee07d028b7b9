"""Addresses of named parts in a compiled model, resolved once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.file.files import reading_models
from hsr8.robots.model.normal_form import ACCELEROMETER, FEET, PADS, SOLES, pad
from hsr8.robots.model.tree import servos_of
from hsr8.world.model.assembly import FIELD

if TYPE_CHECKING:  # reading a run needs no robot
    from hsr8.robots.loaded import LoadedRobot

Ints = NDArray[np.intp]

BEACON, BUMP = f"{FIELD}beacon_", f"{FIELD}bump_"


@dataclass(frozen=True, slots=True)
class ModelIndex:
    """Addresses of the parts that the simulator uses in a compiled model.

    Attributes:
        names: names of the joints (n,).
        root_qpos, root_dof: addresses of the free joint of the robot.
        joint_qpos, joint_dof: addresses of the joints in the order of walking (n,).
        actuators: addresses of the actuators in the same order (n,).
        foot_force: sensor addresses, left and right foot by pad (2, 4).
        accelerometer: sensor addresses (3,).
        foot_sites: site ids of the left and the right foot.
        foot_geoms: geom ids of the left and the right sole.
        floor: geom id of the floor.
        bumps: geom ids of the bumps on the floor.
        base_body: body id of the base.
        trunk: body id of the trunk.
        robot_geoms: ids of the robot's colliding geoms.
        obstacle_of_geom: number of the obstacle of every geom, or of the beacon, counted after all
            obstacles; -1 for other geoms (ngeom,).
        obstacle_geoms: geom id of every obstacle, layout order.
        beacon_geoms: geom ids of the lower and upper half of every beacon, layout order (n, 2).
        mover_mocap: mocap index of every mover, layout order.
    """

    names: tuple[str, ...]
    root_qpos: int
    root_dof: int
    joint_qpos: Ints
    joint_dof: Ints
    actuators: Ints
    foot_force: Ints
    accelerometer: Ints
    foot_sites: tuple[int, int]
    foot_geoms: tuple[int, int]
    floor: int
    bumps: tuple[int, ...]
    base_body: int
    trunk: int
    robot_geoms: Ints
    obstacle_of_geom: Ints
    obstacle_geoms: Ints
    beacon_geoms: Ints
    mover_mocap: Ints

    @classmethod
    @reading_models()
    def of(
        cls, model: mujoco.MjModel, robot: LoadedRobot, n_static: int, n_moving: int
    ) -> ModelIndex:
        """Resolve the names in `model` with a robot, and some static and moving obstacles.

        Raises:
            ModelError: a name is missing.
        """
        names = robot.model.names
        joints = [model.joint(name) for name in names]
        servo = servos_of(model)
        base = model.body(robot.roles.base).id
        root = model.joint(int(model.body_jntadr[base]))
        obstacle_names = [
            *(f"{FIELD}obstacle_{i:02d}" for i in range(n_static)),
            *(f"{FIELD}mover_{i:02d}" for i in range(n_moving)),
        ]
        bodies = [model.body(name) for name in obstacle_names]
        obstacle_geoms = np.array([int(b.geomadr[0]) for b in bodies], dtype=np.intp)
        obstacle_of_geom = np.full(model.ngeom, -1, dtype=np.intp)
        obstacle_of_geom[obstacle_geoms] = np.arange(len(bodies))
        posts = [b for b in map(model.body, range(model.nbody)) if b.name.startswith(BEACON)]
        lower = np.array([int(b.geomadr[0]) for b in posts], dtype=np.intp)
        beacon_geoms = lower[:, None] + np.arange(2)
        obstacle_of_geom[beacon_geoms] = len(bodies) + np.arange(len(posts))[:, None]
        collides = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
        on_robot = np.array([model.body_rootid[b] == base for b in model.geom_bodyid])
        return cls(
            names=names,
            root_qpos=int(root.qposadr[0]),
            root_dof=int(root.dofadr[0]),
            joint_qpos=np.array([j.qposadr[0] for j in joints], dtype=np.intp),
            joint_dof=np.array([j.dofadr[0] for j in joints], dtype=np.intp),
            actuators=np.array([servo[j.id] for j in joints], dtype=np.intp),
            foot_force=np.array(
                [[model.sensor(pad(s, p)).adr[0] for p, _, _ in PADS] for s in range(2)],
                dtype=np.intp,
            ),
            accelerometer=np.arange(3, dtype=np.intp) + model.sensor(ACCELEROMETER).adr[0],
            foot_sites=(model.site(FEET[0]).id, model.site(FEET[1]).id),
            foot_geoms=(model.geom(SOLES[0]).id, model.geom(SOLES[1]).id),
            floor=model.geom(f"{FIELD}floor").id,
            bumps=tuple(g for g in range(model.ngeom) if model.geom(g).name.startswith(BUMP)),
            base_body=base,
            trunk=model.body(robot.roles.trunk).id,
            robot_geoms=np.flatnonzero(collides & on_robot),
            obstacle_of_geom=obstacle_of_geom,
            obstacle_geoms=obstacle_geoms,
            beacon_geoms=beacon_geoms,
            mover_mocap=np.array([int(b.mocapid[0]) for b in bodies[n_static:]], dtype=np.intp),
        )
