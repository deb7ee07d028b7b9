"""Physics body: MuJoCo, several physics steps per control tick."""

from collections.abc import Sequence
from math import isfinite

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import SimulationDiverged
from hsr8.robots.loaded import LoadedRobot
from hsr8.scenario.fault import Fault
from hsr8.scenario.sensors import SensorNoise
from hsr8.world.body.body import Surroundings
from hsr8.world.body.faults import WorldFaults
from hsr8.world.body.pushes import Pusher, ScheduledPush
from hsr8.world.body.sensors import SensorSuite
from hsr8.world.field.layout import Layout
from hsr8.world.rotation import heading, quaternion_from_yaw
from hsr8.world.truth.saturation import Saturation, SaturationWatch
from hsr8.world.truth.truth import Truth
from walking.parameters import CONTROL_PERIOD
from walking.state import BodySensors, JointTargets

Array = NDArray[np.float64]


def place_robot(
    model: mujoco.MjModel, data: mujoco.MjData, robot: LoadedRobot, start: Array
) -> None:
    """Set a robot to its ready posture at x, y, heading `start` (3,) [m, m, rad]."""
    mujoco.mj_resetData(model, data)
    ready = dict(zip(robot.model.names, robot.model.ready.tolist(), strict=True))
    for name, angle in {**robot.held, **ready}.items():
        data.qpos[model.joint(name).qposadr[0]] = angle
    root = int(model.jnt_qposadr[model.body_jntadr[model.body(robot.roles.base).id]])
    x, y, yaw = np.asarray(start, float).tolist()
    data.qpos[root : root + 3] = x, y, robot.height
    data.qpos[root + 3 : root + 7] = quaternion_from_yaw(yaw)
    mujoco.mj_fwdPosition(model, data)
    data.ctrl[:] = data.actuator_length  # also of the joints that walking does not move


class PhysicsBody:
    """Robot in full physics.

    Args:
        model: compiled world.
        robot: robot in it.
        layout: obstacles, beacons and start pose.
        noise: sensor noise.
        rng: generator of the sensors.
        pushes: sorted by start.
        faults: faults of the scenario.

    Raises:
        ValueError: the control period is not a multiple of the physics step.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        robot: LoadedRobot,
        layout: Layout,
        noise: SensorNoise,
        rng: np.random.Generator,
        *,
        pushes: Sequence[ScheduledPush] = (),
        faults: Sequence[Fault] = (),
    ) -> None:
        self.model = model
        self.data = mujoco.MjData(model)
        self._surroundings = Surroundings(model, robot, layout)
        self._index = self._surroundings.index
        self._pusher = Pusher(model, pushes, CONTROL_PERIOD)
        self._faults = WorldFaults(model, self._index, faults, layout.scale)
        self._saturation = SaturationWatch(model, self._index)
        self._suite = SensorSuite(noise, rng, CONTROL_PERIOD, self._index)
        self._substeps = round(CONTROL_PERIOD / model.opt.timestep)
        if abs(self._substeps * model.opt.timestep - CONTROL_PERIOD) > 1e-9:
            raise ValueError(
                f"option timestep: the control period, {CONTROL_PERIOD} s, is not a multiple of "
                f"the physics step, got {model.opt.timestep} s"
            )
        self._substep = 0
        self._timestep = float(model.opt.timestep)
        self._state = np.empty(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_INTEGRATION))
        place_robot(model, self.data, robot, np.array(layout.start))
        self._surroundings.move(self.data, 0.0)
        mujoco.mj_forward(model, self.data)

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._substep * self._timestep

    def sense(self) -> BodySensors:
        return self._suite.read(self.data)

    def setpoints(self, targets: JointTargets) -> Array:
        return targets.setpoint

    def apply(self, targets: JointTargets) -> None:
        """Send the setpoints and advance one control tick.

        Raises:
            SimulationDiverged: MuJoCo warned or the state is no longer finite.
        """
        model, data, surroundings = self.model, self.data, self._surroundings
        data.ctrl[self._index.actuators] = self.setpoints(targets)
        root = self._index.root_qpos
        tick = self._substep // self._substeps
        self._faults.apply_fault(model, data, tick)
        if self._pusher.active(tick):
            # The result must not depend on an update of the poses by a camera.
            mujoco.mj_kinematics(model, data)
            self._pusher.apply(data, tick, heading(data.qpos[root + 3 : root + 7]))
        for _ in range(self._substeps):
            surroundings.step(data, self._substep)
            mujoco.mj_step(model, data)
            self._substep += 1
        surroundings.watch.watch(data)
        self._saturation.watch(data)
        # A sum of squares is finite only if all terms are finite.
        qacc = data.qacc
        if not isfinite(qacc.dot(qacc)) or any(data.warning.number.tolist()):
            raise self._divergence()

    def update_kinematics(self) -> None:
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def movers(self) -> Array:
        return self._surroundings.movers(self.data)

    def truth(self) -> Truth:
        data = self.data
        load, pressure = self._surroundings.watch.feet(data)
        return self._surroundings.truth(
            data,
            self.time,
            joint_torque=data.actuator_force[self._index.actuators],
            foot_force=load,
            zmp=pressure,
            pushes=self._pusher.take(),
        )

    def saturation(self) -> Saturation:
        return self._saturation.so_far()

    def state_bytes(self) -> bytes:
        mujoco.mj_getState(self.model, self.data, self._state, mujoco.mjtState.mjSTATE_INTEGRATION)
        return self._state.tobytes() + self._surroundings.state_bytes()

    def _divergence(self) -> SimulationDiverged:
        """Return the error of a state that is no longer valid."""
        speeds = np.abs(self.data.qvel)
        dof = int(np.argmax(np.where(np.isfinite(speeds), speeds, np.inf)))
        body = self.model.body(self.model.dof_bodyid[dof]).name
        worst = int(np.argmax(np.abs(self.data.ctrl[self._index.actuators])))
        return SimulationDiverged(
            f"the physics diverged at tick {round(self.time / CONTROL_PERIOD)} "
            f"(t = {self.time:.3f} s): body {body!r} moves at {speeds[dof]:.3g} rad/s or m/s; "
            f"largest setpoint of the last command: {self._index.names[worst]} at "
            f"{self.data.ctrl[self._index.actuators[worst]]:.3f} rad"
        )
