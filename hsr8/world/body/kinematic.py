"""Kinematic body: joints follow their targets exactly, the stance foot stays planted.

Footsteps land where the joint targets put them, with a small seeded slip at each change of
support. The loop around the body is the same as with physics.
"""

from math import asin, atan2, cos, pi, sin, sqrt

import mujoco
import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from hsr8.robots.loaded import LoadedRobot
from hsr8.scenario.sensors import SensorNoise
from hsr8.world.body.body import Surroundings
from hsr8.world.body.physics import place_robot
from hsr8.world.body.sensors import SensorSuite
from hsr8.world.field.layout import Layout
from hsr8.world.field.moving_field import REACTION_TICKS
from hsr8.world.rotation import Quaternion, product, rotate
from hsr8.world.truth.truth import Truth
from walking.parameters import CONTROL_PERIOD, GRAVITY
from walking.state import BodySensors, JointTargets

Array = NDArray[np.float64]

# Standard deviations of the slip of a foot at touch-down. With them the robot drifts as in full
# physics, see `walking.estimate.odometry`. Lengths are those in a world of scale 1.
SLIP = 0.0003  # per axis [m]
YAW_SLIP = 0.0006  # about the vertical [rad]
LANDED = 0.0005  # the swing foot becomes the stance foot when lower than it by this [m]
LIFTED = 0.001  # a foot higher than the other one by this carries no load [m]
TILTED = 0.001  # a foot in contact that tilts more than the other one by this carries no load [rad]
BOTH = 2
# Fractions of the weight on the left and the right foot: left, right, double support.
LOAD_FRACTIONS = np.array([[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]])
ORIGIN = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
CONTACT_TICKS = REACTION_TICKS  # control ticks between checks for contacts [1]

Ints = NDArray[np.intp]


class KinematicBody:
    """Robot without dynamics.

    Args:
        model: compiled world.
        robot: robot in it.
        layout: obstacles, beacons and start pose.
        noise: sensor noise.
        rng: generator of sensors and slip.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        robot: LoadedRobot,
        layout: Layout,
        noise: SensorNoise,
        rng: np.random.Generator,
    ) -> None:
        self.model = model
        self.data = mujoco.MjData(model)
        self._surroundings = Surroundings(model, robot, layout)
        self._index = self._surroundings.index
        sensor_rng, self._slip_rng = rng.spawn(2)
        self._suite = SensorSuite(noise, sensor_rng, CONTROL_PERIOD, self._index)
        self._weight = float(model.body_subtreemass[self._index.base_body]) * GRAVITY
        self._slip = np.array([SLIP * layout.scale, SLIP * layout.scale, YAW_SLIP])
        self._landed, self._lifted = LANDED * layout.scale, LIFTED * layout.scale
        self._tick = 0
        sites = list(self._index.foot_sites)
        self._feet = model.site_bodyid[sites].astype(np.intp)
        self._soles = np.hstack([model.site_pos[sites], model.site_quat[sites]])
        place_robot(model, self.data, robot, np.array(layout.start))
        mujoco.mj_kinematics(model, self.data)
        self._joints = self.data.qpos[self._index.joint_qpos].copy()
        self._gyro = np.zeros(3)
        self._force = np.array([0.0, 0.0, GRAVITY])
        self._loads = self._weight * LOAD_FRACTIONS
        self._pads = np.repeat(self._loads[:, :, None] / 4.0, 4, axis=2)
        self._support = BOTH
        self._stance = 0
        self._anchor = self._foot_on_floor(0)
        self._other_sole = np.zeros(4)
        self._plant()
        self._surroundings.react(self.data, 0.0)

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._tick * CONTROL_PERIOD

    def sense(self) -> BodySensors:
        index, sensordata = self._index, self.data.sensordata
        sensordata[index.accelerometer] = self._force
        sensordata[index.foot_force] = self._pads[self._support]
        return self._suite.read(self.data)

    def setpoints(self, targets: JointTargets) -> Array:
        return targets.position

    def apply(self, targets: JointTargets) -> None:
        """Move the joints to their targets and the base over the planted foot.

        The poses in ``data`` are up to date in ticks that check for contacts, and after
        `update_kinematics`.
        """
        self._tick += 1
        rates = (targets.position - self._joints) / CONTROL_PERIOD
        self._joints = targets.position.copy()
        root, dof = self._index.root_qpos, self._index.root_dof
        qpos = self.data.qpos
        before = qpos[root : root + 7].copy()
        qpos[self._index.joint_qpos] = self._joints
        self._plant()
        after, velocity = qpos[root : root + 7], self.data.qvel[dof : dof + 3]
        imu_motion(before, after, CONTROL_PERIOD, velocity, self._gyro, self._force)
        self.data.qvel[dof + 3 : dof + 6] = self._gyro
        self.data.qvel[self._index.joint_dof] = rates
        if self._tick % CONTACT_TICKS == 0:
            self._surroundings.move(self.data, self.time)
            mujoco.mj_kinematics(self.model, self.data)
            mujoco.mj_collision(self.model, self.data)
            self._surroundings.watch.watch(self.data)
            self._surroundings.react(self.data, self.time)

    def movers(self) -> Array:
        return self._surroundings.movers(self.data)

    def update_kinematics(self) -> None:
        self._surroundings.move(self.data, self.time)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def truth(self) -> Truth:
        """Return the ground truth now; the robot falls if its joint targets tip it over."""
        data, surroundings = self.data, self._surroundings
        if self._tick % CONTACT_TICKS:
            surroundings.move(data, self.time)
            mujoco.mj_kinematics(self.model, data)
        feet = data.site_xpos[list(self._index.foot_sites), :2]
        return surroundings.truth(
            data,
            self.time,
            joint_torque=np.zeros(len(self._joints)),
            foot_force=self._loads[self._support],
            zmp=LOAD_FRACTIONS[self._support] @ feet,
        )

    def saturation(self) -> None:
        return None

    def state_bytes(self) -> bytes:
        """Return configuration, movers and pose of the planted foot."""
        numbers = (self.data.qpos, self.data.mocap_pos, self._anchor)
        return b"".join(a.tobytes() for a in numbers) + self._surroundings.state_bytes()

    def _foot_on_floor(self, side: int) -> Array:
        """Return x, y, yaw of a foot projected onto the floor (3,)."""
        site = self._index.foot_sites[side]
        x_axis = self.data.site_xmat[site].reshape(3, 3)[:, 0]
        return np.array([*self.data.site_xpos[site][:2], np.arctan2(x_axis[1], x_axis[0])])

    def _plant(self) -> None:
        """Move the base so that the stance foot lies flat at its anchor."""
        data, root = self.data, self._index.root_qpos
        pose = data.qpos[root : root + 7]
        pose[:] = ORIGIN
        mujoco.mj_kinematics(self.model, data)
        if self._lands(*self._set_base(pose)):
            self._stance = 1 - self._stance
            slip = self._slip_rng.standard_normal(3) * self._slip
            self._anchor = self._other_sole[:3] + slip
            self._set_base(pose)
        self._support = BOTH if self._other_sole[3] < self._lifted else self._stance

    def _lands(self, tilt: float, height: float) -> bool:
        """Return whether the other foot becomes the stance foot.

        A foot whose ankle is at the limit of a joint is not parallel to the floor. If the other
        foot is in contact, too, it carries the robot: the trunk does not tip over the tilted one.

        Args:
            tilt: tilt of the planted sole against that of the other one, see `base_pose` [rad].
            height: height of the other sole above the planted one, see `base_pose` [m].
        """
        if tilt > TILTED:
            return height < self._lifted
        lower = float(self._other_sole[3])
        return lower < -(self._lifted if tilt < -TILTED else self._landed)

    def _set_base(self, pose: Array) -> tuple[float, float]:
        """Set the base over the planted foot; return how the soles lie, see `base_pose`."""
        data = self.data
        return base_pose(
            data.xpos,
            data.xquat,
            self._feet,
            self._soles,
            self._stance,
            self._anchor,
            pose,
            self._other_sole,
        )


@compiled
def base_pose(
    positions: Array,
    attitudes: Array,
    feet: Ints,
    soles: Array,
    stance: int,
    anchor: Array,
    pose: Array,
    other: Array,
) -> tuple[float, float]:
    """Set the base pose with which the planted foot lies flat on the floor at its anchor.

    Args:
        positions: positions of all bodies in the base frame (n, 3) [m].
        attitudes: attitudes of all bodies in the base frame, quaternions (n, 4).
        feet: body indices of the left and the right foot (2,).
        soles: pose of the sole frame in each foot (2, 7).
        stance: planted foot, 0 or 1.
        anchor: x, y and yaw of the planted foot in W (3,) [m, m, rad].
        pose: set to the pose of the base in W (7,).
        other: set to x, y, yaw and height of the other sole in W (4,) [m, m, rad, m].

    Returns:
        tilt of the planted sole against the base, minus that of the other sole [rad]; height of
        the other sole above the planted one if the other one lay flat [m].
    """
    sole_positions = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
    sole_attitudes = [(1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)]
    for side in range(2):
        body, sole = feet[side], soles[side]
        q = (attitudes[body, 0], attitudes[body, 1], attitudes[body, 2], attitudes[body, 3])
        x, y, z = rotate(q, (sole[0], sole[1], sole[2]))
        origin = positions[body]
        sole_positions[side] = (origin[0] + x, origin[1] + y, origin[2] + z)
        sole_attitudes[side] = product(q, (sole[3], sole[4], sole[5], sole[6]))
    w, x, y, z = sole_attitudes[stance]
    half = 0.5 * anchor[2]
    base = product((cos(half), 0.0, 0.0, sin(half)), (w, -x, -y, -z))
    foot = rotate(base, sole_positions[stance])
    pose[0], pose[1], pose[2] = anchor[0] - foot[0], anchor[1] - foot[1], -foot[2]
    pose[3], pose[4], pose[5], pose[6] = base
    offset = rotate(base, sole_positions[1 - stance])
    x_axis = rotate(product(base, sole_attitudes[1 - stance]), (1.0, 0.0, 0.0))
    other[0], other[1] = pose[0] + offset[0], pose[1] + offset[1]
    other[2], other[3] = atan2(x_axis[1], x_axis[0]), pose[2] + offset[2]
    w, x, y, z = sole_attitudes[1 - stance]
    (ax, ay, az), (bx, by, bz) = sole_positions[stance], sole_positions[1 - stance]
    apart = rotate((w, -x, -y, -z), (bx - ax, by - ay, bz - az))
    return _tilt(sole_attitudes[stance]) - _tilt(sole_attitudes[1 - stance]), apart[2]


@compiled
def _tilt(q: Quaternion) -> float:
    """Return the angle between the vertical axes of a frame and its parent [rad]."""
    return 2.0 * asin(min(1.0, sqrt(q[1] * q[1] + q[2] * q[2])))


@compiled
def imu_motion(
    before: Array, after: Array, period: float, velocity: Array, gyro: Array, force: Array
) -> None:
    """Set mean velocity and turn rate between two poses, and the specific force of a body at rest.

    Args:
        before: pose (7,).
        after: pose (7,), `period` later.
        period: time between them [s].
        velocity: set to the velocity of the origin in W (3,) [m/s].
        gyro: set to the angular velocity in the body's frame (3,) [rad/s].
        force: set to the specific force in the body's frame (3,) [m/s²].
    """
    for k in range(3):
        velocity[k] = (after[k] - before[k]) / period
    q = (after[3], after[4], after[5], after[6])
    w, x, y, z = product((before[3], -before[4], -before[5], -before[6]), q)
    size = sqrt(x * x + y * y + z * z)
    angle = 2.0 * atan2(size, w)
    if angle > pi:  # shorter rotation
        angle -= 2.0 * pi
    rate = angle / (size * period) if size > 0.0 else 0.0
    gyro[0], gyro[1], gyro[2] = rate * x, rate * y, rate * z
    force[0], force[1], force[2] = rotate((q[0], -q[1], -q[2], -q[3]), (0.0, 0.0, GRAVITY))
