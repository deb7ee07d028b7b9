"""Walk of a robot on an empty floor, in full physics with sensor noise."""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import acos, degrees

import numpy as np
from numpy.typing import NDArray

from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.scenario.sensors import SensorNoise
from hsr8.world.body.physics import PhysicsBody
from hsr8.world.body.pushes import ScheduledPush
from hsr8.world.field.layout import Layout
from hsr8.world.model.assembly import Optics, assemble
from hsr8.world.model.index import ModelIndex
from hsr8.world.rotation import heading, up_component
from hsr8.world.truth.saturation import Saturation
from walking.body.robot_model import RobotModel
from walking.body.tree import RIGHT_LEG
from walking.command import Command, HeadTarget, VelocityCommand
from walking.dimension import HSR_VIII
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD, GRAVITY, WalkingParameters
from walking.state import HeadCameraPose

Array = NDArray[np.float64]
Names = tuple[str, str]

EMPTY = Layout((4.0, 4.0), (), (), (0.0, 0.0, 0.0), np.zeros((0, 2)), None, endless=False)
TOUCHED = 0.002  # of a walk in which two parts touch, from which they limit it [1]
FAST = 0.9  # of its maximum speed, at which a joint limits a walk [1]
REFERENCE_FORCE = HSR_VIII.weight  # that the noise of the foot pads is stated for [N]


@dataclass(frozen=True, slots=True, eq=False)
class Walked:
    """A walk of n control ticks.

    Attributes:
        falls: number of falls; the walk ends with the first.
        poses: x, y [m] and unwrapped heading [rad] of the robot frame (n, 3).
        odometry: the same by odometry (n, 3).
        tilt: tilt of the trunk (n,) [deg].
        targets: joint targets (n, joints) [rad].
        angles: joint angles after each tick (n, joints) [rad].
        camera: believed minus true camera pose: tilt, roll, yaw [rad], height [m], at
            every `CAMERA_TICKS` (m, 4).
        steps: completed footsteps.
        saturation: saturation of the joints.
        touching: control ticks in which two bodies of the robot touch, by their names.
        parameters: parameters of the walk.
    """

    falls: int
    poses: Array
    odometry: Array
    tilt: Array
    targets: Array
    angles: Array
    camera: Array
    steps: int
    saturation: Saturation
    touching: Mapping[Names, int]
    parameters: WalkingParameters

    def velocity(self, settling: float = 3.0) -> Array:
        """Return the mean velocity in the robot frame over whole strides (3,) [m/s, m/s, rad/s].

        Args:
            settling: time before the first stride that counts, in that of HSR-VIII [s].
        """
        step = self.parameters.gait.footstep_time
        begin = round(settling * step / WalkingParameters().gait.footstep_time / CONTROL_PERIOD)
        stride = 2 * round(step / CONTROL_PERIOD)
        poses = self.poses[begin:]
        ticks = (len(poses) - 1) // stride * stride
        if ticks <= 0:
            return np.full(3, np.nan)
        moved, yaw = np.diff(poses[: ticks + 1, :2], axis=0), poses[:ticks, 2]
        c, s = np.cos(yaw), np.sin(yaw)
        forward, left = c * moved[:, 0] + s * moved[:, 1], c * moved[:, 1] - s * moved[:, 0]
        turned = poses[ticks, 2] - poses[0, 2]
        time = ticks * CONTROL_PERIOD
        return np.array([forward.sum(), left.sum(), turned]) / time

    def limit(self, robot: RobotModel) -> str:
        """Return what limited the walk, in words.

        It is a contact of two parts, else the leg joint that was longest at a limit.

        Args:
            robot: robot that walked.
        """
        if self.touching:
            (one, other), touched = max(self.touching.items(), key=lambda item: item[1])
            if touched > TOUCHED * len(self.poses):
                of_walk = f"{touched / len(self.poses):.1%} of the walk"
                return f"{one} and {other} touch for {of_walk}: state another posture"
        uses, ticks = self.saturation, len(self.poses)
        legs = slice(0, RIGHT_LEG.stop)
        at = np.array([uses.torque_ticks[legs], uses.stop_ticks[legs]]) / ticks
        fastest = uses.peak_speed[legs] / robot.tree.speed[legs]
        kind, joint = (int(k) for k in np.unravel_index(at.argmax(), at.shape))
        if at[kind, joint] > 0.0:
            name = robot.names[joint]
            limits = (
                f"its maximum torque of {robot.tree.effort[joint]:.3g} N m",
                "the end of its range",
            )
            return f"{name} at {limits[kind]} for {at[kind, joint]:.0%} of the walk"
        joint = int(fastest.argmax())
        if fastest[joint] > FAST:
            return (
                f"{robot.names[joint]} at {fastest[joint]:.0%} of its maximum speed of "
                f"{robot.tree.speed[joint]:.3g} rad/s"
            )
        return "no joint at a limit"


CAMERA_TICKS = 12  # control ticks between samples of the camera pose


class Trial:
    """Walks of one robot; the model is compiled once.

    Args:
        robot: robot that walks.
        parameters: parameters of its walk; derived ones by default.
        noise: factor on the sensor noise [1].
    """

    def __init__(
        self, robot: LoadedRobot, parameters: WalkingParameters | None = None, noise: float = 1.0
    ) -> None:
        self.robot = robot
        self.parameters = parameters or robot.parameters
        self._model = assemble(robot, EMPTY, "vision", Optics())
        self._noise = _scaled_noise(noise, robot.model)
        self._joints = ModelIndex.of(self._model, robot, 0, 0).joint_qpos
        self._own = self._model.body_rootid == self._model.body(robot.roles.base).rootid[0]
        self._camera = self._model.camera(HEAD_CAMERA).id

    def walk(
        self,
        command: Callable[[float], Command] | VelocityCommand,
        duration: float,
        seed: int = 0,
        *,
        head: Callable[[float], HeadTarget] | None = None,
        pushes: tuple[ScheduledPush, ...] = (),
    ) -> Walked:
        """Walk until a fall or the end.

        Args:
            command: constant, or by time.
            duration: [s].
            seed: seed of the sensor noise.
            head: target by time.
            pushes: pushes on the robot.
        """
        rng = np.random.default_rng([seed, 7])
        body = PhysicsBody(self._model, self.robot, EMPTY, self._noise, rng, pushes=pushes)
        engine = WalkingEngine(self.robot.model, self.parameters)
        rows, camera, falls, touching = [], [], 0, Counter[Names]()
        for tick in range(round(duration / CONTROL_PERIOD)):
            time = tick * CONTROL_PERIOD
            now = command if isinstance(command, VelocityCommand) else command(time)
            targets = engine.step(body.sense(), now, head(time) if head else HeadTarget())
            state = engine.state()
            if tick % CAMERA_TICKS == 0:
                camera.append(self._camera_error(body, state.camera))
            body.apply(targets)
            touching.update(self._touching(body))
            truth, odometry = body.truth(), state.odometry
            tilt = degrees(acos(min(1.0, up_component(truth.qpos[3:7]))))
            pose = (odometry.x, odometry.y, odometry.yaw)
            rows.append([*truth.robot, *pose, tilt, *targets.position, *truth.qpos[self._joints]])
            if truth.fallen:
                falls = 1
                break
        table, n = np.array(rows), len(self._joints)
        table[:, 2] = np.unwrap(table[:, 2])
        return Walked(
            falls=falls,
            poses=table[:, :3],
            odometry=table[:, 3:6],
            tilt=table[:, 6],
            targets=table[:, 7 : 7 + n],
            angles=table[:, 7 + n :],
            camera=np.array(camera),
            steps=state.step_count,
            saturation=body.saturation(),
            touching=touching,
            parameters=self.parameters,
        )

    def _touching(self, body: PhysicsBody) -> set[Names]:
        """Return the bodies of the robot that touch each other."""
        pairs = self._model.geom_bodyid[body.data.contact.geom]
        pairs = np.sort(pairs[self._own[pairs].all(axis=1)], axis=1)
        return {(self._model.body(a).name, self._model.body(b).name) for a, b in pairs.tolist()}

    def _camera_error(self, body: PhysicsBody, believed: HeadCameraPose) -> Array:
        """Return believed minus true camera pose: tilt, roll, yaw [rad], height [m] (4,)."""
        body.update_kinematics()
        data = body.data
        # MuJoCo cameras look along -z with y up.
        true = data.cam_xmat[self._camera].reshape(3, 3) * (1.0, -1.0, -1.0)
        yaw = heading(data.qpos[3:7])
        c, s = np.cos(yaw), np.sin(yaw)
        level = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ true
        off = believed.rotation.T @ level
        turned = 0.5 * np.array(
            [off[2, 1] - off[1, 2], off[0, 2] - off[2, 0], off[1, 0] - off[0, 1]]
        )
        height = float(data.cam_xpos[self._camera, 2])
        return np.array([-turned[0], -turned[2], -turned[1], believed.position[2] - height])


def _scaled_noise(factor: float, robot: RobotModel) -> SensorNoise:
    """Return the usual noise times a factor, that of the foot pads in proportion to the weight."""
    usual = SensorNoise()
    scaled = {name: factor * getattr(usual, name) for name in SensorNoise.__dataclass_fields__}
    scaled["foot_force"] *= robot.mass * GRAVITY / REFERENCE_FORCE
    return SensorNoise(**scaled)
