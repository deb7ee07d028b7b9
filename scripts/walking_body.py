"""A robot in full physics under sensor noise, with errors of its model to order."""

from collections import deque
from dataclasses import dataclass
from pathlib import Path

from walking.body.joints import JOINT_NAMES
from walking.parameters import CONTROL_PERIOD
from walking.sensing import BodySensors

import mujoco
import numpy as np

ROBOT = Path(__file__).resolve().parents[1] / "models" / "hsr8" / "hsr8.xml"
FALLEN_SHARE = 0.64  # of the height of the ready robot's hips
FALLEN_COSINE = 0.5
SUBSTEPS = 2
BUMP_FIELD = 2.5  # half of the side of the square with bumps [m]
BUMP_FREE = 0.25  # half of the side of the square without, in its middle [m]
BUMPS = 500
DITCH = 0.2  # width of a ditch and of the board next to it [m]
DITCH_FIELD = 4.0  # half of the side of the square with ditches [m]


@dataclass(frozen=True)
class Plant:
    """What body and floor are in truth; the engine knows the nominal ones.

    Attributes:
        robot: MJCF file.
        noise: multiple of the sensor noise [1].
        friction: between soles and floor [1].
        mass: multiple of all masses [1].
        com_forward, com_left: shift of the centre of mass [m].
        delay: of the servos' setpoints, in control ticks [1].
        slope: of the floor, uphill in the direction `uphill` [rad].
        uphill: that direction [rad].
        bump: height of the boxes strewn on the floor [m].
        ditch: depth of the ditches across the floor, 0.2 m wide and 0.2 m apart [m].
        self_contact: whether trunk, head and arms touch the rest of the body, too; the model
            leaves that out.
    """

    robot: Path = ROBOT
    noise: float = 1.0
    friction: float = 0.8
    mass: float = 1.0
    com_forward: float = 0.0
    com_left: float = 0.0
    delay: int = 0
    slope: float = 0.0
    uphill: float = 0.0
    bump: float = 0.0
    ditch: float = 0.0
    self_contact: bool = False

    @property
    def floor_quaternion(self) -> np.ndarray:
        """Attitude of the floor (4,)."""
        c, s = np.cos(0.5 * self.slope), np.sin(0.5 * self.slope)
        return np.array([c, s * np.sin(self.uphill), -s * np.cos(self.uphill), 0.0])


def build(plant: Plant, rng: np.random.Generator) -> mujoco.MjModel:
    """Model of a plant; its errors are in the source, so that all derived numbers follow."""
    spec = mujoco.MjSpec.from_file(str(plant.robot))
    floor = spec.worldbody.add_geom(
        name="floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], quat=plant.floor_quaternion
    )
    bumps = [_bump(spec, plant.bump, rng) for _ in range(BUMPS)] if plant.bump > 0.0 else []
    slats = _slats(spec, plant.ditch) if plant.ditch > 0.0 else []
    floor.pos = [0.0, 0.0, -plant.ditch]
    for geom in (floor, *bumps, *slats):
        geom.condim = 4
        geom.contype = geom.conaffinity = 3
        geom.friction = [plant.friction, 0.01, 0.001]
        geom.solref[:] = [0.01, 1.0]
        geom.solimp[:3] = [0.9, 0.95, 0.001]
    for geom in spec.geoms:
        if geom.name.endswith("_sole"):
            geom.friction = [plant.friction, 0.01, 0.001]
    if plant.self_contact:
        _touch_oneself(spec)
    total = sum(body.mass for body in spec.bodies)
    torso = spec.body("torso_link")
    shift = np.array([plant.com_forward, plant.com_left, 0.0])
    torso.ipos = torso.ipos + total / torso.mass * shift
    for body in spec.bodies:
        body.mass *= plant.mass
        body.inertia = plant.mass * body.inertia
    return spec.compile()


def _touch_oneself(spec: mujoco.MjSpec) -> None:
    """Let all that is solid touch, but for the thighs and the pelvis that they hang on."""
    for geom in spec.geoms:
        if geom.contype or geom.conaffinity:
            geom.contype = geom.conaffinity = 7
    for side in "lr":
        spec.add_exclude(bodyname1="base_link", bodyname2=f"{side}_hip_pitch_link")


def _bump(spec: mujoco.MjSpec, height: float, rng: np.random.Generator) -> mujoco.MjsGeom:
    """A box somewhere on the floor, away from where the robot begins."""
    position = np.zeros(2)
    while max(abs(position)) < BUMP_FREE:
        position = rng.uniform(-BUMP_FIELD, BUMP_FIELD, 2)
    turn = rng.uniform(0.0, np.pi)
    return spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=[*position, 0.0],
        size=[*rng.uniform(0.02, 0.07, 2), height],
        quat=[np.cos(0.5 * turn), 0.0, 0.0, np.sin(0.5 * turn)],
    )


def _slats(spec: mujoco.MjSpec, depth: float) -> list[mujoco.MjsGeom]:
    """Boards across the path, their tops at the height of the floor; the robot begins on one."""
    return [
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=[x, 0.0, -0.5 * depth],
            size=[0.5 * DITCH, DITCH_FIELD, 0.5 * depth],
        )
        for x in np.arange(-DITCH_FIELD, DITCH_FIELD, 2.0 * DITCH)
    ]


class Body:
    """A robot on a floor with noisy sensors.

    Args:
        rng: of noise and bumps.
        plant: in truth.
    """

    def __init__(self, rng: np.random.Generator, plant: Plant) -> None:
        self.model = build(plant, rng)
        self.data = mujoco.MjData(self.model)
        model, data = self.model, self.data
        mujoco.mj_resetDataKeyframe(model, data, model.key("walk_ready").id)
        self._lying = FALLEN_SHARE * data.qpos[2]
        upright, at = data.qpos[3:7].copy(), data.qpos[:3].copy()
        mujoco.mju_mulQuat(data.qpos[3:7], plant.floor_quaternion, upright)
        mujoco.mju_rotVecQuat(data.qpos[:3], at, plant.floor_quaternion)
        mujoco.mj_forward(model, data)
        noise = plant.noise
        self._rng, self._noise = rng, noise
        self._qpos = np.array([model.joint(n).qposadr[0] for n in JOINT_NAMES])
        self._dof = np.array([model.joint(n).dofadr[0] for n in JOINT_NAMES])
        self._pads = np.array(
            [
                model.sensor(f"{side}_sole_{pad}_force").adr[0]
                for side in "lr"
                for pad in ("fl", "fr", "bl", "br")
            ]
        )
        self._gyro = model.sensor("imu_gyro").adr[0]
        self._accelerometer = model.sensor("imu_accelerometer").adr[0]
        self._pad_gain = 1.0 + 0.05 * noise * rng.standard_normal(8)
        self._yaw = 0.0
        self._ctrl = deque([data.ctrl.copy()] * plant.delay, maxlen=plant.delay + 1)
        self.torso = model.body("torso_link").id
        c, s = np.cos(plant.slope), np.sin(plant.slope)
        self._normal = np.array([-s * np.cos(plant.uphill), -s * np.sin(plant.uphill), c])
        self._camera = model.camera("egocentric").id

    def sense(self) -> BodySensors:
        """Read all sensors."""
        data, rng, n = self.data, self._rng, self._noise
        self._yaw += 0.001 * n * np.sqrt(CONTROL_PERIOD) * rng.standard_normal()
        small = np.array([1.0, *(0.5 * 0.005 * n * rng.standard_normal(2)), 0.0])
        turned, tilted = np.empty(4), np.empty(4)
        drift = np.array([np.cos(0.5 * self._yaw), 0.0, 0.0, np.sin(0.5 * self._yaw)])
        mujoco.mju_mulQuat(turned, drift, data.qpos[3:7])
        mujoco.mju_mulQuat(tilted, turned, small / np.linalg.norm(small))
        sd = data.sensordata
        force = sd[self._pads] * self._pad_gain + 0.2 * n * rng.standard_normal(8)
        return BodySensors(
            joint_position=data.qpos[self._qpos] + 0.0005 * n * rng.standard_normal(26),
            joint_velocity=data.qvel[self._dof] + 0.02 * n * rng.standard_normal(26),
            gyro=data.qvel[3:6] + 0.01 * n * rng.standard_normal(3),
            accelerometer=sd[self._accelerometer : self._accelerometer + 3].copy(),
            orientation=tilted,
            foot_force=np.maximum(force, 0.0).reshape(2, 4),
        )

    def apply(self, ctrl: np.ndarray) -> None:
        """Advance one control tick."""
        self._ctrl.append(ctrl)
        self.data.ctrl[:] = self._ctrl[0]
        for _ in range(SUBSTEPS):
            mujoco.mj_step(self.model, self.data)

    @property
    def up(self) -> float:
        """Cosine of the tilt of the trunk."""
        _, x, y, _ = self.data.qpos[3:7]
        return float(1.0 - 2.0 * (x * x + y * y))

    @property
    def fallen(self) -> bool:
        """Whether the robot lies."""
        return bool(self._normal @ self.data.qpos[:3] < self._lying or self.up < FALLEN_COSINE)

    @property
    def pose(self) -> np.ndarray:
        """True x, y, heading (3,)."""
        w, x, y, z = self.data.qpos[3:7]
        yaw = np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        return np.array([*self.data.qpos[:2], yaw])

    @property
    def self_contact(self) -> bool:
        """Whether the body touches itself."""
        pairs = self.model.geom_bodyid[self.data.contact.geom]
        return bool((pairs != 0).all(axis=1).any())

    def camera_error(self, R_RC: np.ndarray, p_RC: np.ndarray) -> np.ndarray:
        """Believed minus true camera: pan direction, elevation [rad], height [m] (3,)."""
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)
        axis = -self.data.cam_xmat[self._camera].reshape(3, 3)[:, 2]
        yaw = self.pose[2]
        believed = R_RC[:, 2]
        across = np.arctan2(believed[1], believed[0]) - np.arctan2(axis[1], axis[0]) + yaw
        return np.array(
            [
                np.arctan2(np.sin(across), np.cos(across)),
                np.arcsin(believed[2]) - np.arcsin(axis[2]),
                p_RC[2] - self.data.cam_xpos[self._camera, 2],
            ]
        )
