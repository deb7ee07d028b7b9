"""Rows of the tables of a run: one line for each column with its source, text, unit and shape.

Poses are those of the robot frame R: x, y, heading [m, m, rad]. W is the world frame. Quantities
"in odometry" are in the odometry frame of the robot, which drifts.
"""

from typing import TYPE_CHECKING

import numpy as np

from hsr8.recorder.columns import BOOL, BYTES, INT, TEXT, VARYING, Column, Row
from hsr8.recorder.frame_row import FRAME, POSE, POSE_COVARIANCE, VELOCITY, camera_columns
from walking.command import Limit
from walking.plane import Array

if TYPE_CHECKING:  # reading a run needs no robot
    from hsr8.record import Tick, TickRecord

JOINTS = ("joints",)
LIMIT_TEXT = "active limits of the command, bit k for limit k of `walking.command.Limit`"
DEPTH = "distance of the planned ZMP from the edge of the soles, negative outside"
PADS = "front-left, front-right, back-left and back-right"
LIMITS = tuple(Limit)
"""Limits in the order of their bits."""
BITS = {limit: 1 << k for k, limit in enumerate(LIMITS)}


def limit_bits(limits: tuple[Limit, ...]) -> int:
    """Return the bits of active limits."""
    bits = 0
    for limit in limits:
        bits |= BITS[limit]
    return bits


def _tick_limits(tick: "Tick") -> int:
    return limit_bits(tick.limits)


def _limits(record: "TickRecord") -> int:
    """Return the bits of the limits of the command, none without a report."""
    report = record.walking.command_limits
    return 0 if report is None else limit_bits(report.limits)


def _limited_command(record: "TickRecord") -> Array | tuple[float, ...]:
    """Return the command before its limits (3,) [m/s, m/s, rad/s], NaN without a report."""
    report = record.walking.command_limits
    return np.full(3, np.nan) if report is None else report.commanded.velocity


TICK = Row(
    "Sensors, as the robot receives them, and setpoints of one control tick.",
    Column("tick", "number", "number of the control tick", type=INT),
    Column("time", "time", "simulated time", "s"),
    Column("joint_position", "sensors.joint_position", "encoder angles", "rad", JOINTS),
    Column("joint_velocity", "sensors.joint_velocity", "encoder rates", "rad/s", JOINTS),
    Column("gyro", "sensors.gyro", "angular velocity of the trunk in the IMU frame", "rad/s", (3,)),
    Column(
        "accelerometer", "sensors.accelerometer", "specific force in the IMU frame", "m/s²", (3,)
    ),
    Column(
        "orientation", "sensors.orientation", "attitude of the IMU, quaternion w-x-y-z", "1", (4,)
    ),
    Column(
        "foot_force",
        "sensors.foot_force",
        f"force under the {PADS} pad of the left and the right foot",
        "N",
        (2, 4),
    ),
    Column(
        "setpoint",
        "setpoint",
        "setpoints of the servos; NaN in the last tick, whose setpoints are not sent",
        "rad",
        JOINTS,
    ),
    Column("limits", _tick_limits, LIMIT_TEXT, type=INT),
    Column("zmp_depth", "zmp_depth", DEPTH, "m"),
    Column("down", "down", "whether the robot lies or gets up", type=BOOL),
    Column(
        "walking_time",
        "walking_time",
        "wall time of the walking engine, the only column that differs between repeated runs",
        "s",
    ),
)

CONTACT = Row(
    "Contact of the robot with an obstacle or a beacon.",
    Column("obstacle", "obstacle", "number in the layout: obstacles, then beacons", type=INT),
    Column("name", "name", "name of the obstacle or beacon, for people", type=TEXT),
    Column("moving", "moving", "whether it is a mover", type=BOOL),
    Column("robot_geom", "robot_geom", "name of the geom of the robot, or of its body", type=TEXT),
    Column("force", "force", "normal force", "N"),
    Column("closing", "closing", "whether the motion of the robot closed the gap", type=BOOL),
)

PUSH = Row(
    "Push that acts on the robot.",
    Column("number", "number", "number of the push in its run", type=INT),
    Column("begin", "begin", "start of the push", "s"),
    Column("duration", "duration", "total duration", "s"),
    Column("body", "body", "name of the pushed body", type=TEXT),
    Column(
        "direction",
        "direction",
        "direction from the heading of the robot at the start, counter-clockwise",
        "rad",
    ),
    Column("point", "point", "point of the force in W", "m", (3,)),
    Column("force", "force", "force in W", "N", (3,)),
)

FOOTHOLD = Row(
    "Planned pose of a foot on the floor.",
    Column("left", "left", "whether it is the left foot", type=BOOL),
    Column("x", "x", "position of the foot frame", "m"),
    Column("y", "y", "position of the foot frame", "m"),
    Column("yaw", "yaw", "yaw of the foot", "rad"),
)

RECORD = Row(
    "True state of the world and state of the walking engine, every 20 ms.",
    Column("tick", "tick", "number of the control tick", type=INT),
    Column("time", "time", "simulated time", "s"),
    Column(
        "qpos",
        "truth.qpos",
        "true generalised position of the robot, MuJoCo order",
        "m, rad",
        ("nq",),
    ),
    Column("robot", "truth.robot", "true pose", POSE, (3,)),
    Column(
        "obstacle_positions",
        "truth.obstacle_positions",
        "axes of all obstacles in W, layout order",
        "m",
        ("obstacles", 2),
    ),
    Column(
        "obstacle_velocities",
        "truth.obstacle_velocities",
        "velocities of the axes in W",
        "m/s",
        ("obstacles", 2),
    ),
    Column(
        "clearance",
        "truth.clearance",
        "true distance of the robot to the nearest obstacle or beacon",
        "m",
    ),
    Column("joint_torque", "truth.joint_torque", "true torque", "N m", JOINTS),
    Column(
        "foot_load",
        "truth.foot_force",
        "true normal force under the left and right foot",
        "N",
        (2,),
    ),
    Column(
        "cop",
        "truth.zmp",
        "true centre of pressure under both feet in W, NaN when airborne",
        "m",
        (2,),
    ),
    Column("fallen", "truth.fallen", "whether the robot has fallen", type=BOOL),
    Column("contacts", "truth.contacts", "contacts since the previous row", items=CONTACT),
    Column("pushes", "truth.pushes", "pushes active since the previous row", items=PUSH),
    Column("phase", "walking.phase", "gait phase", type=TEXT),
    Column(
        "odometry",
        ("walking.odometry.x", "walking.odometry.y", "walking.odometry.yaw"),
        "pose in odometry, heading unwrapped",
        POSE,
        (3,),
    ),
    Column(
        "odometry_covariance",
        "walking.odometry.covariance",
        "covariance of its error, see `walking.odometry`",
        POSE_COVARIANCE,
        (3, 3),
    ),
    *camera_columns("walking.camera", "", "camera", "head"),
    Column("head_target", ("head.pan", "head.tilt"), "commanded pan and tilt", "rad", (2,)),
    Column("command", "command.velocity", "commanded velocity vx, vy, wz", VELOCITY, (3,)),
    Column(
        "applied_velocity",
        "walking.applied_velocity",
        "velocity that the footsteps follow",
        VELOCITY,
        (3,),
    ),
    Column(
        "limited_command",
        _limited_command,
        "command that `limits` refer to, NaN before the first",
        VELOCITY,
        (3,),
    ),
    Column("limits", _limits, LIMIT_TEXT, type=INT),
    Column(
        "footsteps",
        "walking.footsteps",
        "planned footholds in odometry, the support foot first",
        items=FOOTHOLD,
    ),
    Column("step_count", "walking.step_count", "completed steps", type=INT),
    Column("zmp", "walking.zmp", "planned zero-moment point in odometry", "m", (2,)),
    Column("com", "walking.balance.com", "planned centre of mass in odometry", "m", (2,)),
    Column("measured_com", "walking.com", "measured centre of mass in odometry", "m", (2,)),
    Column("dcm", "walking.dcm", "planned divergent component of motion in odometry", "m", (2,)),
    Column(
        "measured_dcm",
        "walking.balance.dcm",
        "measured divergent component of motion in odometry",
        "m",
        (2,),
    ),
    Column(
        "support",
        "walking.balance.support",
        "corners of the planned support polygon in odometry, counter-clockwise",
        "m",
        (VARYING, 2),
    ),
    Column("zmp_depth", "walking.balance.zmp_depth", DEPTH, "m"),
    Column(
        "feet",
        "walking.balance.feet",
        "references of the left and right foot in odometry: x, y, height, yaw",
        "m, rad",
        (2, 4),
    ),
    Column(
        "capture",
        "walking.balance.capture",
        "shift of the landing by the capture step in odometry",
        "m",
        (2,),
    ),
    Column("roll", "walking.roll", "measured roll of the trunk", "rad"),
    Column("pitch", "walking.pitch", "measured pitch of the trunk", "rad"),
    Column(
        "believes_fallen",
        "walking.fallen",
        "whether the robot believes that it has fallen",
        type=BOOL,
    ),
)

SECOND = Row(
    "Hashes of the state and saturation of the servos so far, every second and at the end.",
    Column("tick", "tick", "number of the next control tick", type=INT),
    Column("time", "time", "simulated time", "s"),
    Column("world", "world", "hash of the state of the world", type=BYTES),
    Column("robot", "robot", "hash of the state of the world and the belief", type=BYTES),
    Column(
        "torque_saturated",
        "saturation.torque_any",
        "ticks with a joint at its maximum torque",
        type=INT,
        optional=True,
    ),
    Column(
        "torque_saturated_by",
        "saturation.torque_ticks",
        "ticks at the maximum torque, by joint",
        "1",
        JOINTS,
        INT,
        optional=True,
    ),
    Column(
        "at_stop",
        "saturation.stop_any",
        "ticks with a joint at the end of its range",
        type=INT,
        optional=True,
    ),
    Column(
        "at_stop_by",
        "saturation.stop_ticks",
        "ticks at the end of the range, by joint",
        "1",
        JOINTS,
        INT,
        optional=True,
    ),
    Column(
        "peak_torque",
        "saturation.peak_torque",
        "peak torque over maximum torque",
        "1",
        JOINTS,
        optional=True,
    ),
    Column("peak_speed", "saturation.peak_speed", "peak speed", "rad/s", JOINTS, optional=True),
)

EVENT = Row(
    "Event.",
    Column("time", "time", "simulated time", "s"),
    Column(
        "kind",
        "kind",
        "fault, push, collision, fall, via_point, goal, lost, relocalized or diverged",
        type=TEXT,
    ),
    Column("text", "text", "description", type=TEXT),
)

IMAGE = Row(
    "Image of the head camera.",
    Column("index", "index", "number of its frame", type=INT),
    Column("time", "time", "time at which the frame reached the robot", "s"),
    Column("captured", "captured", "time at which the image was taken", "s"),
    Column("jpeg", "jpeg", "the image", type=BYTES),
)

TABLES = {
    "ticks": TICK,
    "records": RECORD,
    "frames": FRAME,
    "seconds": SECOND,
    "events": EVENT,
    "images": IMAGE,
}
