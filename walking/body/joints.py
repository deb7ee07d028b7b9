"""Names and order of the 26 joints, in the actuators of the model and in every array."""

LEG_JOINTS = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
ARM_JOINTS = ("shoulder_pitch", "shoulder_roll", "elbow_yaw", "elbow_pitch", "wrist_yaw", "gripper")
HEAD_JOINTS = ("head_pan", "head_tilt")

JOINT_NAMES: tuple[str, ...] = (
    *(f"l_{name}" for name in LEG_JOINTS),
    *(f"r_{name}" for name in LEG_JOINTS),
    *HEAD_JOINTS,
    *(f"l_{name}" for name in ARM_JOINTS),
    *(f"r_{name}" for name in ARM_JOINTS),
)

LEFT_LEG = slice(0, 6)
RIGHT_LEG = slice(6, 12)
HEAD = slice(12, 14)
LEFT_ARM = slice(14, 20)
RIGHT_ARM = slice(20, 26)
