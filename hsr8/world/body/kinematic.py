"""A body without dynamics: joints follow their targets, the stance foot stays planted.

Footsteps land exactly where the joint targets put them, but for a small seeded slip at
each change of support. It serves fast tuning and tests; the loop around it is the same.
"""

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.sensor_noise import SensorNoise
from hsr8.world.body.kinematic_kernel import GRAVITY, felt, stand
from hsr8.world.body.physics import place_robot
from hsr8.world.body.sensors import SensorSuite
from hsr8.world.body.surroundings import Surroundings
from hsr8.world.field.layout import Layout
from hsr8.world.rotation import heading
from hsr8.world.truth.truth import Truth
from walking.parameters import CONTROL_PERIOD
from walking.sensing import BodySensors
from walking.targets import JointTargets

Array = NDArray[np.float64]

# Standard deviations of a foot's slip at touch-down. With them the robot drifts as in full
# physics, see `walking.odometry`.
SLIP = 0.0003  # per axis [m]
YAW_SLIP = 0.0006  # about the vertical [rad]
LANDED = 0.0005  # the swing foot takes over when it is lower than the stance foot by this [m]
LIFTED = 0.001  # a foot higher than the other by this carries nothing [m]
BOTH = 2
SHARES = np.array([[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]])  # of the weight on the left and right foot
ORIGIN = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
WATCH_TICKS = 4  # contacts with obstacles are looked for every 20 ms


class KinematicBody:
    """The robot without physics.

    Args:
        model: compiled world.
        layout: what stands and moves in it.
        noise: sensor noise.
        rng: generator of sensors and slip.
    """

    def __init__(
        self, model: mujoco.MjModel, layout: Layout, noise: SensorNoise, rng: np.random.Generator
    ) -> None:
        self.model = model
        self.data = mujoco.MjData(model)
        self._around = Surroundings(model, layout)
        self._index = self._around.index
        sensor_rng, self._slip_rng = rng.spawn(2)
        self._suite = SensorSuite(noise, sensor_rng, CONTROL_PERIOD)
        self._weight = float(model.body_subtreemass[self._index.base_body]) * GRAVITY
        self._tick = 0
        sites = list(self._index.foot_sites)
        self._feet = model.site_bodyid[sites].astype(np.intp)
        self._soles = np.hstack([model.site_pos[sites], model.site_quat[sites]])
        place_robot(model, self.data, np.array(layout.start))
        mujoco.mj_kinematics(model, self.data)
        self._joints = self.data.qpos[self._index.joint_qpos].copy()
        self._rates = np.zeros_like(self._joints)
        self._gyro = np.zeros(3)
        self._force = np.array([0.0, 0.0, GRAVITY])
        self._loads = self._weight * SHARES
        self._pads = np.repeat(self._loads[:, :, None] / 4.0, 4, axis=2)
        self._carrying = BOTH
        self._stance = 0
        self._anchor = self._foot_on_floor(0)
        self._other = np.zeros(4)
        self._plant()

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._tick * CONTROL_PERIOD

    def sense(self) -> BodySensors:
        """Read encoders, IMU and foot pads, computed from the planned motion."""
        root = self._index.root_qpos
        return self._suite.read(
            joint_position=self._joints,
            joint_velocity=self._rates,
            gyro=self._gyro,
            accelerometer=self._force,
            orientation=self.data.qpos[root + 3 : root + 7],
            foot_force=self._pads[self._carrying],
        )

    def set_points(self, targets: JointTargets) -> Array:
        """What the servos are told (26,) [rad]."""
        return targets.position

    def apply(self, targets: JointTargets) -> None:
        """Put the joints at their targets and the body where the planted foot says.

        The poses in ``data`` are those of the world in the ticks that look for contacts, and
        after `update_kinematics`.
        """
        self._tick += 1
        self._rates = (targets.position - self._joints) / CONTROL_PERIOD
        self._joints = targets.position.copy()
        root, dof = self._index.root_qpos, self._index.root_dof
        qpos = self.data.qpos
        before = qpos[root : root + 7].copy()
        qpos[self._index.joint_qpos] = self._joints
        self._plant()
        after, velocity = qpos[root : root + 7], self.data.qvel[dof : dof + 3]
        felt(before, after, CONTROL_PERIOD, velocity, self._gyro, self._force)
        self.data.qvel[dof + 3 : dof + 6] = self._gyro
        self.data.qvel[self._index.joint_dof] = self._rates
        if self._tick % WATCH_TICKS == 0:
            self._around.move(self.data, self.time)
            mujoco.mj_kinematics(self.model, self.data)
            mujoco.mj_collision(self.model, self.data)
            self._around.watch.watch(self.data)

    def update_kinematics(self) -> None:
        """Bring all poses up to date."""
        self._around.move(self.data, self.time)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def truth(self) -> Truth:
        """State of the world now; a kinematic robot never falls."""
        data, root = self.data, self._index.root_qpos
        if self._tick % WATCH_TICKS:
            self._around.move(data, self.time)
            mujoco.mj_kinematics(self.model, data)
        robot = np.array(
            [*data.qpos[root : root + 2].tolist(), heading(data.qpos[root + 3 : root + 7])]
        )
        feet = data.site_xpos[list(self._index.foot_sites), :2]
        return Truth(
            time=self.time,
            qpos=data.qpos.copy(),
            robot=robot,
            obstacle_positions=self._around.positions(self.time),
            obstacle_velocities=self._around.velocities(self.time),
            contacts=self._around.watch.take(),
            clearance=self._around.watch.clearance(data),
            joint_torque=np.zeros(len(self._joints)),
            foot_force=self._loads[self._carrying],
            zmp=SHARES[self._carrying] @ feet,
            fallen=False,
        )

    def state_bytes(self) -> bytes:
        """Configuration, movers and the place of the planted foot."""
        return b"".join(a.tobytes() for a in (self.data.qpos, self.data.mocap_pos, self._anchor))

    def _foot_on_floor(self, side: int) -> Array:
        """x, y, yaw of a foot projected onto the floor (3,)."""
        site = self._index.foot_sites[side]
        x_axis = self.data.site_xmat[site].reshape(3, 3)[:, 0]
        return np.array([*self.data.site_xpos[site][:2], np.arctan2(x_axis[1], x_axis[0])])

    def _plant(self) -> None:
        """Move the base so that the stance foot lies flat where it is anchored."""
        data, root = self.data, self._index.root_qpos
        pose = data.qpos[root : root + 7]
        pose[:] = ORIGIN
        mujoco.mj_kinematics(self.model, data)
        self._stand(pose)
        if self._other[3] < -LANDED:
            self._stance = 1 - self._stance
            slip = self._slip_rng.standard_normal(3) * (SLIP, SLIP, YAW_SLIP)
            self._anchor = self._other[:3] + slip
            self._stand(pose)
        self._carrying = BOTH if self._other[3] < LIFTED else self._stance

    def _stand(self, pose: Array) -> None:
        data = self.data
        stand(
            data.xpos,
            data.xquat,
            self._feet,
            self._soles,
            self._stance,
            self._anchor,
            pose,
            self._other,
        )
