"""Common parts of the two robot bodies, physics and kinematic: protocol, obstacles around them."""

from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.loaded import LoadedRobot
from hsr8.world.field.layout import Layout
from hsr8.world.field.moving_field import REACTION_TICKS, moving_field
from hsr8.world.model.index import ModelIndex
from hsr8.world.rotation import heading, up_component
from hsr8.world.truth.contacts import ContactWatch
from hsr8.world.truth.saturation import Saturation
from hsr8.world.truth.truth import ActivePush, Truth
from walking.parameters import CONTROL_PERIOD
from walking.state import BodySensors, JointTargets


class Body(Protocol):
    """A robot in its world, advanced one control tick at a time."""

    model: mujoco.MjModel
    data: mujoco.MjData

    @property
    def time(self) -> float:
        """Simulated time [s]."""

    def sense(self) -> BodySensors:
        """Read encoders, IMU and foot pads."""

    def setpoints(self, targets: JointTargets) -> NDArray[np.float64]:
        """Return the servo setpoints (n,) [rad]; as `targets` they have the same effect."""

    def apply(self, targets: JointTargets) -> None:
        """Advance one control tick towards `targets`."""

    def update_kinematics(self) -> None:
        """Update the poses in ``data`` from its state, for a camera."""

    def movers(self) -> NDArray[np.float64]:
        """Return the positions of the movers in ``data``, layout order (n, 2) [m]."""

    def truth(self) -> Truth:
        """Return the ground truth now, with the contacts since the last call."""

    def saturation(self) -> Saturation | None:
        """Return the saturation of the servos so far; None without dynamics."""

    def state_bytes(self) -> bytes:
        """Return the state that determines the future of the world, for hashing."""


Array = NDArray[np.float64]

BLOCK = 256  # physics steps per computation of the motion of the movers
FALLEN_DROP = 0.36  # of the base, of the height of base or hips, from which it has fallen [1]
FALLEN_TILT = 0.5  # cosine of the tilt, below which the robot has fallen [1]


class Surroundings:
    """Obstacles of a layout in its compiled model.

    Args:
        model: compiled world.
        robot: robot in it.
        layout: obstacles and beacons.

    Attributes:
        index: addresses in the model.
        watch: contacts of the robot.
    """

    def __init__(self, model: mujoco.MjModel, robot: LoadedRobot, layout: Layout) -> None:
        static = layout.static
        self._field = moving_field(layout)
        self._n_movers = len(layout.movers)
        self._static = np.reshape([o.position for o in static], (-1, 2))
        self._at_rest = np.zeros_like(self._static)
        height = max(robot.height, robot.parameters.pattern.pelvis_height)
        self._lowest = robot.height - FALLEN_DROP * height
        self.index = ModelIndex.of(model, robot, len(static), self._n_movers)
        self.watch = ContactWatch(model, self.index, layout)
        self._timestep = float(model.opt.timestep)
        steps = round(REACTION_TICKS * CONTROL_PERIOD / self._timestep)
        n = self._n_block = steps if self._field.reacts else BLOCK
        self._first, self._block = -n, np.zeros((n, model.nmocap, 3))
        self._row, self._ends, self._velocities = 0, np.full(n, np.nan), np.zeros((n, 0, 2))

    def move(self, data: mujoco.MjData, time: float) -> None:
        """Move every mover to its position at `time` [s]."""
        if self._n_movers:
            data.mocap_pos[self.index.mover_mocap, :2] = self._field.positions(time)

    def react(self, data: mujoco.MjData, time: float) -> None:
        """Let the movers react to the robot, every `REACTION_TICKS` control ticks."""
        x, y = data.qpos[self.index.root_qpos : self.index.root_qpos + 2].tolist()
        self._field.react(time, (x, y))

    def movers(self, data: mujoco.MjData) -> Array:
        """Return the positions of the movers in `data`, layout order (n, 2) [m]."""
        movers: Array = data.mocap_pos.take(self.index.mover_mocap, axis=0)[:, :2]
        return movers

    def state_bytes(self) -> bytes:
        """Return the state of the movers that a function of time does not give."""
        return self._field.state_bytes()

    def step(self, data: mujoco.MjData, number: int) -> None:
        """Move every mover to its position at the end of physics step `number`, counted from 0."""
        if self._n_movers == 0:
            return
        if not 0 <= number - self._first < self._n_block:
            self._first = number
            self.react(data, number * self._timestep)
            self._ends = np.arange(number + 1.0, number + 1.0 + self._n_block) * self._timestep
            self._block[:] = data.mocap_pos
            self._block[:, self.index.mover_mocap, :2] = self._field.positions(self._ends)
            self._velocities = self._field.velocities(self._ends)
        self._row = number - self._first
        data.mocap_pos[:] = self._block[self._row]

    def truth(
        self,
        data: mujoco.MjData,
        time: float,
        *,
        joint_torque: Array,
        foot_force: Array,
        zmp: Array,
        pushes: tuple[ActivePush, ...] = (),
    ) -> Truth:
        """Return the ground truth of robot and obstacles, with the contacts since the last call.

        Args:
            data: state of the world, with its poses.
            time: simulated time [s].
            joint_torque: torques of the joints (n,) [N m].
            foot_force: normal force under the left and right foot (2,) [N].
            zmp: centre of pressure under both feet in W (2,) [m].
            pushes: pushes since the last call.
        """
        qpos, root = data.qpos.copy(), self.index.root_qpos
        x, y, z = qpos[root : root + 3].tolist()
        attitude = qpos[root + 3 : root + 7]
        low = z < self._lowest
        stepped = self._ends[self._row] == time
        moving = self._velocities[self._row] if stepped else self._field.velocities(time)
        return Truth(
            time=time,
            qpos=qpos,
            robot=np.array([x, y, heading(attitude)]),
            obstacle_positions=np.concatenate([self._static, self.movers(data)]),
            obstacle_velocities=np.concatenate([self._at_rest, moving]),
            mover_clocks=self._field.clocks(time),
            contacts=self.watch.take(),
            clearance=self.watch.clearance(data),
            joint_torque=joint_torque,
            foot_force=foot_force,
            zmp=zmp,
            fallen=low or up_component(attitude) < FALLEN_TILT,
            pushes=pushes,
        )
