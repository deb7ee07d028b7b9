"""Custom walker: a learned policy of MuJoCo Playground, run by onnxruntime.

    pip install onnxruntime
    export POLICY=t1_policy.onnx
    hsr8 run course --robot examples/t1_playground.toml \
        --set plugin.walker=examples/onnx_walker.py:BoosterT1

The policies of Booster T1 and Unitree G1 are published by MuJoCo Playground (Apache-2.0) in
``mujoco_playground/experimental/sim2sim/onnx``. They follow a velocity at 50 Hz. Their
observation is the velocity of the trunk, its angular velocity, the direction of gravity, the
command, positions relative to the default pose and velocities of the joints, the last action, and
the phase of the gait. The action is the change of the joint setpoints from the default pose.

The velocity is the robot's own estimate, by leg odometry; a policy never sees the ground truth.
"""

import os

import numpy as np

POLICY = os.environ.get("POLICY", "policy.onnx")
PERIOD = 0.02  # of the policy [s]
GAIT = 1.5  # strides per second [1/s]


class Policy:
    """Policy of MuJoCo Playground; a subclass describes its robot."""

    default: dict[str, float]  # default pose, the joints in the order of the policy [rad]
    scale: float  # setpoint change per action [rad]
    free_head = False  # whether the policy leaves the head to the robot
    stops = False  # whether the gait stops without a command

    def __init__(self):
        try:
            import onnxruntime  # noqa: PLC0415 (not a dependency of hsr8)
        except ImportError as error:
            raise ImportError("onnxruntime is missing; pip install onnxruntime") from error
        if not os.path.isfile(POLICY):
            raise FileNotFoundError(f"POLICY: {POLICY!r} does not exist; expected an .onnx file")
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1  # the result of a run must not depend on the machine
        self.session = onnxruntime.InferenceSession(
            POLICY, options, providers=["CPUExecutionProvider"]
        )

    def start(self, robot):
        missing = [name for name in self.default if name not in robot.joint_names]
        if missing:
            raise ValueError(f"the robot lacks the joints {', '.join(missing)}")
        self.joints = [robot.joint_names.index(name) for name in self.default]
        self.pose = np.array(list(self.default.values()))
        self.head, self.ready = robot.head, robot.ready
        self.held = [self.joints.index(joint) for joint in robot.head] if self.free_head else []
        self.every = round(PERIOD / robot.period)

    def reset(self):
        self.tick = 0
        self.phase = np.array([0.0, np.pi])
        self.action = np.zeros(len(self.joints))

    def step(self, sensors, command, head, estimate):
        if self.tick % self.every == 0:
            self.action = self.act(sensors, command, estimate)
            self.phase = np.fmod(self.phase + 2.0 * np.pi * GAIT * PERIOD + np.pi, 2.0 * np.pi)
            self.phase -= np.pi
        self.tick += 1
        setpoints = self.ready.copy()
        setpoints[self.joints] = self.pose + self.scale * self.action
        setpoints[self.head] = head
        return setpoints

    def act(self, sensors, command, estimate):
        """Return the action of the policy (n,)."""
        w, x, y, z = sensors.orientation
        gravity = -np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
        position = sensors.joint_position[self.joints] - self.pose
        velocity = sensors.joint_velocity[self.joints].copy()
        position[self.held] = velocity[self.held] = 0.0
        phase = self.phase
        if self.stops and np.linalg.norm(command.velocity) < 0.01:
            phase = np.full(2, np.pi)
        observation = [estimate.velocity, sensors.gyro, gravity, command.velocity]
        observation += [position, velocity, self.action, np.cos(phase), np.sin(phase)]
        inputs = {"obs": np.concatenate(observation).astype(np.float32)[None]}
        (action,) = self.session.run(["continuous_actions"], inputs)
        return action[0].astype(float)


class BoosterT1(Policy):
    """Booster T1 with 23 joints."""

    scale = 1.0
    free_head = stops = True
    default = {
        **{"AAHead_yaw": 0.0, "Head_pitch": 0.0},
        **{"Left_Shoulder_Pitch": 0.0, "Left_Shoulder_Roll": -1.4},
        **{"Left_Elbow_Pitch": 0.0, "Left_Elbow_Yaw": -0.4},
        **{"Right_Shoulder_Pitch": 0.0, "Right_Shoulder_Roll": 1.4},
        **{"Right_Elbow_Pitch": 0.0, "Right_Elbow_Yaw": 0.4, "Waist": 0.0},
        **{"Left_Hip_Pitch": -0.2, "Left_Hip_Roll": 0.0, "Left_Hip_Yaw": 0.0},
        **{"Left_Knee_Pitch": 0.4, "Left_Ankle_Pitch": -0.2, "Left_Ankle_Roll": 0.0},
        **{"Right_Hip_Pitch": -0.2, "Right_Hip_Roll": 0.0, "Right_Hip_Yaw": 0.0},
        **{"Right_Knee_Pitch": 0.4, "Right_Ankle_Pitch": -0.2, "Right_Ankle_Roll": 0.0},
    }


LEG = {"hip_pitch": -0.312, "hip_roll": 0.0, "hip_yaw": 0.0}
LEG |= {"knee": 0.669, "ankle_pitch": -0.363, "ankle_roll": 0.0}
ARM = {"shoulder_pitch": 0.2, "shoulder_roll": 0.2, "shoulder_yaw": 0.0, "elbow": 0.6}
ARM |= {"wrist_roll": 0.0, "wrist_pitch": 0.0, "wrist_yaw": 0.0}


class UnitreeG1(Policy):
    """Unitree G1 with 29 joints."""

    scale = 0.5
    default = {
        **{
            f"{side}_{name}_joint": angle
            for side in ("left", "right")
            for name, angle in LEG.items()
        },
        **{"waist_yaw_joint": 0.0, "waist_roll_joint": 0.0, "waist_pitch_joint": 0.073},
        **{f"left_{name}_joint": angle for name, angle in ARM.items()},
        **{f"right_{name}_joint": angle for name, angle in (ARM | {"shoulder_roll": -0.2}).items()},
    }
