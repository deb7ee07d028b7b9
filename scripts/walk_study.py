"""Walk the engine in full physics under sensor noise and report how well it does.

    python scripts/walk_study.py random --seeds 1000 1001 --duration 120
    python scripts/walk_study.py steady --forward 0.25 --duration 60
    python scripts/walk_study.py push --impulse 1.0
    python scripts/walk_study.py profile

Tune on seeds 0-99, report on seeds from 1000.
"""

import argparse
import cProfile
import dataclasses
import pstats
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import mujoco
import numpy as np

from walking.command import HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.joints import JOINT_NAMES
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.robot_model import RobotModel
from walking.sensing import BodySensors

ROBOT = Path(__file__).resolve().parents[1] / "models" / "hsr8" / "hsr8.xml"
FALLEN_HEIGHT = 0.13  # [m]
FALLEN_COSINE = 0.5
SUBSTEPS = 2
SAMPLE = 4  # ticks between two rows of a trace
SAMPLE_TIME = SAMPLE * CONTROL_PERIOD

Script = Callable[[float], tuple[VelocityCommand, HeadTarget]]


class Body:
    """HSR-VIII on a plain floor with noisy sensors."""

    def __init__(self, rng: np.random.Generator, noise: float = 1.0, friction: float = 0.8) -> None:
        spec = mujoco.MjSpec.from_file(str(ROBOT))
        floor = spec.worldbody.add_geom(
            name="floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], condim=4
        )
        floor.contype = floor.conaffinity = 3
        floor.friction = [friction, 0.01, 0.001]
        floor.solref[:] = [0.01, 1.0]
        floor.solimp[:3] = [0.9, 0.95, 0.001]
        for geom in spec.geoms:
            if geom.name.endswith("_sole"):
                geom.friction = [friction, 0.01, 0.001]
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        model = self.model
        mujoco.mj_resetDataKeyframe(model, self.data, model.key("walk_ready").id)
        mujoco.mj_forward(model, self.data)
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
        self.torso = model.body("torso_link").id
        self._floor = model.geom("floor").id
        self._camera = model.camera("egocentric").id

    def sense(self) -> BodySensors:
        """Read all sensors."""
        data, rng, n = self.data, self._rng, self._noise
        self._yaw += 0.001 * n * np.sqrt(CONTROL_PERIOD) * rng.standard_normal()
        small = np.array([1.0, *(0.5 * 0.0025 * n * rng.standard_normal(2)), 0.0])
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
        self.data.ctrl[:] = ctrl
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
        return bool(self.data.qpos[2] < FALLEN_HEIGHT or self.up < FALLEN_COSINE)

    @property
    def pose(self) -> np.ndarray:
        """True x, y, heading (3,)."""
        w, x, y, z = self.data.qpos[3:7]
        yaw = np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        return np.array([*self.data.qpos[:2], yaw])

    @property
    def self_contact(self) -> bool:
        """Whether the body touches itself."""
        pairs = self.data.contact.geom
        return bool((pairs != self._floor).all(axis=1).any()) if len(pairs) else False

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


@dataclass
class Trace:
    """What a walk left behind, one row every `SAMPLE` ticks."""

    tilt: list[float] = field(default_factory=list)
    truth: list[np.ndarray] = field(default_factory=list)
    odometry: list[tuple[float, float, float]] = field(default_factory=list)
    steps: list[int] = field(default_factory=list)
    camera_error: list[np.ndarray] = field(default_factory=list)
    falls: list[float] = field(default_factory=list)
    self_contacts: int = 0
    ticks: int = 0
    wall_engine: float = 0.0
    wall_physics: float = 0.0

    def sample(self, body: Body, engine: WalkingEngine) -> None:
        """Note where the body is and where the engine believes it to be."""
        state = engine.state()
        odometry, camera = state.odometry, state.camera
        self.tilt.append(float(np.degrees(np.arccos(min(1.0, body.up)))))
        self.truth.append(body.pose)
        self.odometry.append((odometry.x, odometry.y, odometry.yaw))
        self.steps.append(state.step_count)
        self.self_contacts += body.self_contact
        self.camera_error.append(body.camera_error(camera.rotation, camera.position))


def walk(
    engine_of: Callable[[], WalkingEngine],
    body_of: Callable[[], Body],
    script: Script,
    duration: float,
    disturb: Callable[[Body, float], None] | None = None,
) -> Trace:
    """Walk a script; after a fall a fresh robot goes on."""
    trace = Trace()
    body, engine = body_of(), engine_of()
    for tick in range(round(duration / CONTROL_PERIOD)):
        now = tick * CONTROL_PERIOD
        command, head = script(now)
        sensors = body.sense()
        start = time.process_time()
        targets = engine.step(sensors, command, head)
        trace.wall_engine += time.process_time() - start
        if tick % SAMPLE == 0:
            trace.sample(body, engine)
        if disturb is not None:
            disturb(body, now)
        start = time.process_time()
        body.apply(targets.position + targets.offset)
        trace.wall_physics += time.process_time() - start
        trace.ticks += 1
        if body.fallen:
            trace.falls.append(now)
            body, engine = body_of(), engine_of()
    return trace


def random_script(seed: int) -> Script:
    """Random commands within the box, stops, and a head that saccades."""
    rng = np.random.default_rng([seed, 7])
    box = ((-0.15, 0.30), (-0.10, 0.10), (-1.0, 1.0))
    schedule: list[tuple[float, VelocityCommand]] = []
    now = 0.0
    while now < 4000.0:
        draw = rng.uniform()
        values = [rng.uniform(*side) for side in box]
        if draw < 0.15:
            values = [0.0, 0.0, 0.0]
        elif draw < 0.3:
            values = [side[rng.integers(2)] for side in box]
        schedule.append((now, VelocityCommand(*map(float, values))))
        now += rng.uniform(0.5, 2.0)
    gaze = rng.uniform((-1.5, -0.8), (1.5, 0.2), (20000, 2)).tolist()
    state = {"next": 0, "command": VelocityCommand()}

    def script(now: float) -> tuple[VelocityCommand, HeadTarget]:
        if state["next"] < len(schedule) and schedule[state["next"]][0] <= now:
            state["command"] = schedule[state["next"]][1]
            state["next"] += 1
        pan, tilt = gaze[int(now / 0.2) % len(gaze)]
        return state["command"], HeadTarget(pan, tilt)

    return script


def steady_script(command: VelocityCommand) -> Script:
    """One command for ever."""
    return lambda _now: (command, HeadTarget())


def in_heading(rows: np.ndarray) -> np.ndarray:
    """Displacements between poses (n, 3), in the heading of the earlier one (n - 1, 3)."""
    d, yaw = np.diff(rows, axis=0), rows[:-1, 2]
    c, s = np.cos(yaw), np.sin(yaw)
    return np.stack([c * d[:, 0] + s * d[:, 1], c * d[:, 1] - s * d[:, 0], d[:, 2]], axis=1)


def upright(trace: Trace) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Truth, odometry (n, 3) and step counts (n,) until the first fall."""
    end = round(trace.falls[0] / SAMPLE_TIME) if trace.falls else len(trace.steps)
    truth, odometry = np.array(trace.truth[:end]), np.array(trace.odometry[:end])
    truth[:, 2] = np.unwrap(truth[:, 2])
    return truth, odometry, np.array(trace.steps[:end])


def report(name: str, trace: Trace) -> None:
    """A few lines."""
    tilt = np.array(trace.tilt)
    truth, odometry, steps = upright(trace)
    window = round(5.0 / SAMPLE_TIME)
    moved, believed = in_heading(truth[::window]), in_heading(odometry[::window])
    errors = np.linalg.norm((believed - moved)[:, :2], axis=1)
    stride = np.flatnonzero(np.diff(steps)) + 1
    path = np.linalg.norm(np.diff(truth[stride, :2], axis=0), axis=1).sum()
    scale = np.linalg.norm(believed[:, :2], axis=1).sum() / max(
        1e-9, np.linalg.norm(moved[:, :2], axis=1).sum()
    )
    yaw = truth[:, 2] - odometry[:, 2]
    print(
        f"{name}: falls {len(trace.falls)} {[round(t, 1) for t in trace.falls][:4]}, "
        f"{steps[-1]} steps, tilt p50/p99/p99.9/max "
        f"{np.percentile(tilt, 50):.2f} {np.percentile(tilt, 99):.2f} "
        f"{np.percentile(tilt, 99.9):.2f} {tilt.max():.1f} deg, "
        f"self contact {trace.self_contacts} of {len(tilt)} samples"
    )
    if len(stride) > 2:
        step_error = in_heading(odometry[stride]) - in_heading(truth[stride])
        print(
            f"    odometry {100.0 * errors.sum() / path:.1f} cm/m over 5 s windows, "
            f"scale {scale:.3f}, yaw {np.degrees(yaw[-1] - yaw[0]):+.2f} deg; a footstep's error "
            f"mean {(1e3 * step_error.mean(axis=0)).round(2).tolist()} "
            f"std {(1e3 * step_error.std(axis=0)).round(2).tolist()} mm, mm, mrad"
        )
    across, elevation, height = (1e3 * np.array(trace.camera_error).std(axis=0)).tolist()
    print(
        f"    camera std: bearing {across:.1f} mrad, elevation {elevation:.1f} mrad, "
        f"height {height:.2f} mm; engine {1e6 * trace.wall_engine / trace.ticks:.0f} us, "
        f"physics {1e6 * trace.wall_physics / trace.ticks:.0f} us a tick",
        flush=True,
    )


def mean_velocity(trace: Trace, settle: float = 3.0) -> np.ndarray:
    """Mean forward, left, turn velocity after `settle` [m/s, m/s, rad/s] (3,)."""
    truth, _, _ = upright(trace)
    stride = 34  # two footsteps, so that the sway cancels
    rows = truth[round(settle / SAMPLE_TIME) :: stride]
    return in_heading(rows).mean(axis=0) / (stride * SAMPLE_TIME)


def parameters_of(settings: list[str]) -> WalkingParameters:
    """Default parameters with `group.name=value` settings."""
    parameters = WalkingParameters()
    for setting in settings:
        key, text = setting.split("=")
        group, name = key.split(".")
        section = getattr(parameters, group)
        value = type(getattr(section, name))(text)
        section = dataclasses.replace(section, **{name: value})
        parameters = dataclasses.replace(parameters, **{group: section})
    return parameters


def main() -> None:
    """Run one of the studies."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", choices=("random", "steady", "push", "profile"))
    parser.add_argument("--seeds", type=int, nargs="+", default=[0])
    parser.add_argument("--duration", type=float, default=60.0)
    parser.add_argument("--forward", type=float, default=0.0)
    parser.add_argument("--left", type=float, default=0.0)
    parser.add_argument("--turn", type=float, default=0.0)
    parser.add_argument("--impulse", type=float, default=1.0, help="of a push [N s]")
    parser.add_argument("--noise", type=float, default=1.0, help="multiple of the sensor noise")
    parser.add_argument("--friction", type=float, default=0.8)
    parser.add_argument("--set", nargs="*", default=[], help="parameters, group.name=value")
    options = parser.parse_args()
    robot = RobotModel.from_mjcf(ROBOT)
    parameters = parameters_of(options.set)
    command = VelocityCommand(options.forward, options.left, options.turn)

    def engine() -> WalkingEngine:
        return WalkingEngine(robot, parameters)

    if options.study == "profile":
        body, walker = Body(np.random.default_rng(0)), engine()
        frames = []
        for _ in range(2000):
            sensors = body.sense()
            frames.append(sensors)
            targets = walker.step(sensors, command, HeadTarget())
            body.apply(targets.position + targets.offset)
        walker = engine()
        with cProfile.Profile() as profile:
            for sensors in frames:
                walker.step(sensors, command, HeadTarget())
        pstats.Stats(profile).sort_stats("tottime").print_stats(25)
        return
    for seed in options.seeds:
        rng = np.random.default_rng([seed, 3])

        def body(rng: np.random.Generator = rng) -> Body:
            return Body(rng, options.noise, options.friction)

        if options.study == "random":
            report(f"random {seed}", walk(engine, body, random_script(seed), options.duration))
        elif options.study == "steady":
            trace = walk(engine, body, steady_script(command), options.duration)
            report(f"steady {seed} {mean_velocity(trace).round(3).tolist()}", trace)
        else:
            push_study(seed, engine, body, command, options.impulse)


def push_study(
    seed: int,
    engine: Callable[[], WalkingEngine],
    body: Callable[[], Body],
    command: VelocityCommand,
    impulse: float,
) -> None:
    """Eight directions by four phases, 50 ms each, survival 2.5 s after."""
    rng = np.random.default_rng([seed, 11])
    survived = np.zeros((8, 4), bool)
    for direction in range(8):
        angle = direction * np.pi / 4.0
        force = impulse / 0.05 * np.array([np.cos(angle), np.sin(angle)])
        for phase in range(4):
            begin = 2.5 + 0.17 * (phase + rng.uniform())

            def disturb(
                robot: Body, now: float, begin: float = begin, force: np.ndarray = force
            ) -> None:
                on = begin <= now < begin + 0.05
                robot.data.xfrc_applied[robot.torso, :2] = force if on else 0.0

            trace = walk(engine, body, steady_script(command), begin + 2.5, disturb)
            survived[direction, phase] = not trace.falls
    print(f"push {impulse} N s seed {seed}: {survived.mean():.0%}", survived.mean(axis=1).tolist())


if __name__ == "__main__":
    main()
