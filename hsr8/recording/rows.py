"""Rows of the tables of a run: one line for each column with its source, text, unit and shape.

Poses are those of the robot frame R: x, y, heading [m, m, rad]. W is the world frame. Quantities
"in odometry" are in the odometry frame of the robot, which drifts.
"""

from typing import TYPE_CHECKING

import numpy as np

from hsr8.recording.columns import BOOL, BYTES, INT, TEXT, VARYING, Column, Row
from hsr8.recording.frame_row import FRAME, POSE, POSE_COVARIANCE, VELOCITY, camera_columns
from walking.command import Limit
from walking.plane import Array

if TYPE_CHECKING:  # reading a run needs no robot
    from hsr8.simulation.record import Tick, TickRecord

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
    Column("number", "number of the control tick", type=INT, name="tick"),
    Column("time", "simulated time", "s"),
    Column("sensors.joint_position", "encoder angles", "rad", JOINTS),
    Column("sensors.joint_velocity", "encoder rates", "rad/s", JOINTS),
    Column("sensors.gyro", "angular velocity of the trunk in the IMU frame", "rad/s", (3,)),
    Column("sensors.accelerometer", "specific force in the IMU frame", "m/s²", (3,)),
    Column("sensors.orientation", "attitude of the IMU, quaternion w-x-y-z", "1", (4,)),
    Column(
        "sensors.foot_force",
        f"force under the {PADS} pad of the left and the right foot",
        "N",
        (2, 4),
    ),
    Column(
        "setpoint",
        "setpoints of the servos; NaN in the last tick, whose setpoints are not sent",
        "rad",
        JOINTS,
    ),
    Column(_tick_limits, LIMIT_TEXT, type=INT, name="limits"),
    Column("zmp_depth", DEPTH, "m"),
    Column("down", "whether the robot lies or gets up", type=BOOL),
    Column(
        "walking_time",
        "wall time of the walking engine, the only column that differs between repeated runs",
        "s",
    ),
)

CONTACT = Row(
    "Contact of the robot with an obstacle or a beacon.",
    Column("obstacle", "number in the layout: obstacles, then beacons", type=INT),
    Column("name", "name of the obstacle or beacon, for people", type=TEXT),
    Column("moving", "whether it is a mover", type=BOOL),
    Column("robot_geom", "name of the geom of the robot, or of its body", type=TEXT),
    Column("force", "normal force", "N"),
    Column("closing", "whether the motion of the robot closed the gap", type=BOOL),
)

PUSH = Row(
    "Push that acts on the robot.",
    Column("number", "number of the push in its run", type=INT),
    Column("begin", "start of the push", "s"),
    Column("duration", "total duration", "s"),
    Column("body", "name of the pushed body", type=TEXT),
    Column(
        "direction",
        "direction from the heading of the robot at the start, counter-clockwise",
        "rad",
    ),
    Column("point", "point of the force in W", "m", (3,)),
    Column("force", "force in W", "N", (3,)),
)

FOOTHOLD = Row(
    "Planned pose of a foot on the floor.",
    Column("left", "whether it is the left foot", type=BOOL),
    Column("x", "position of the foot frame", "m"),
    Column("y", "position of the foot frame", "m"),
    Column("yaw", "yaw of the foot", "rad"),
)

RECORD = Row(
    "True state of the world and state of the walking engine, every 20 ms.",
    Column("tick", "number of the control tick", type=INT),
    Column("time", "simulated time", "s"),
    Column("truth.qpos", "true generalised position of the robot, MuJoCo order", "m, rad", ("nq",)),
    Column("truth.robot", "true pose", POSE, (3,)),
    Column(
        "truth.obstacle_positions",
        "axes of all obstacles in W, layout order",
        "m",
        ("obstacles", 2),
    ),
    Column("truth.obstacle_velocities", "velocities of the axes in W", "m/s", ("obstacles", 2)),
    Column(
        "truth.mover_clocks",
        "time of every mover on its lane, behind `time` where it has waited for the robot; empty "
        "without movers that yield",
        "s",
        ("clocks",),
    ),
    Column("truth.clearance", "true distance of the robot to the nearest obstacle or beacon", "m"),
    Column("truth.joint_torque", "true torque", "N m", JOINTS),
    Column(
        "truth.foot_force",
        "true normal force under the left and right foot",
        "N",
        (2,),
        name="foot_load",
    ),
    Column(
        "truth.zmp",
        "true centre of pressure under both feet in W, NaN when airborne",
        "m",
        (2,),
        name="cop",
    ),
    Column("truth.fallen", "whether the robot has fallen", type=BOOL),
    Column("truth.contacts", "contacts since the previous row", items=CONTACT),
    Column("truth.pushes", "pushes active since the previous row", items=PUSH),
    Column("walking.phase", "gait phase", type=TEXT),
    Column(
        ("walking.odometry.x", "walking.odometry.y", "walking.odometry.yaw"),
        "pose in odometry, heading unwrapped",
        POSE,
        (3,),
        name="odometry",
    ),
    Column(
        "walking.odometry.covariance",
        "covariance of its error, see `walking.estimate.odometry`",
        POSE_COVARIANCE,
        (3, 3),
        name="odometry_covariance",
    ),
    *camera_columns("walking.camera", "", "camera", "head"),
    Column(("head.pan", "head.tilt"), "commanded pan and tilt", "rad", (2,), name="head_target"),
    Column("command.velocity", "commanded velocity vx, vy, wz", VELOCITY, (3,), name="command"),
    Column("walking.applied_velocity", "velocity that the footsteps follow", VELOCITY, (3,)),
    Column(
        _limited_command,
        "command that `limits` refer to, NaN before the first",
        VELOCITY,
        (3,),
        name="limited_command",
    ),
    Column(_limits, LIMIT_TEXT, type=INT, name="limits"),
    Column(
        "walking.footsteps", "planned footholds in odometry, the support foot first", items=FOOTHOLD
    ),
    Column("walking.step_count", "completed steps", type=INT),
    Column("walking.zmp", "planned zero-moment point in odometry", "m", (2,)),
    Column("walking.balance.com", "planned centre of mass in odometry", "m", (2,)),
    Column("walking.com", "measured centre of mass in odometry", "m", (2,), name="measured_com"),
    Column("walking.dcm", "planned divergent component of motion in odometry", "m", (2,)),
    Column(
        "walking.balance.dcm",
        "measured divergent component of motion in odometry",
        "m",
        (2,),
        name="measured_dcm",
    ),
    Column(
        "walking.balance.support",
        "corners of the planned support polygon in odometry, counter-clockwise",
        "m",
        (VARYING, 2),
    ),
    Column("walking.balance.zmp_depth", DEPTH, "m"),
    Column(
        "walking.balance.feet",
        "references of the left and right foot in odometry: x, y, height, yaw",
        "m, rad",
        (2, 4),
    ),
    Column(
        "walking.balance.capture", "shift of the landing by the capture step in odometry", "m", (2,)
    ),
    Column("walking.roll", "measured roll of the trunk", "rad"),
    Column("walking.pitch", "measured pitch of the trunk", "rad"),
    Column(
        "walking.fallen",
        "whether the robot believes that it has fallen",
        type=BOOL,
        name="believes_fallen",
    ),
)

SECOND = Row(
    "Hashes of the state and saturation of the servos so far, every second and at the end.",
    Column("tick", "number of the next control tick", type=INT),
    Column("time", "simulated time", "s"),
    Column("world", "hash of the state of the world", type=BYTES),
    Column("robot", "hash of the state of the world and the belief", type=BYTES),
    Column(
        "saturation.torque_any",
        "ticks with a joint at its maximum torque",
        type=INT,
        optional=True,
        name="torque_saturated",
    ),
    Column(
        "saturation.torque_ticks",
        "ticks at the maximum torque, by joint",
        "1",
        JOINTS,
        INT,
        optional=True,
        name="torque_saturated_by",
    ),
    Column(
        "saturation.stop_any",
        "ticks with a joint at the end of its range",
        type=INT,
        optional=True,
        name="at_stop",
    ),
    Column(
        "saturation.stop_ticks",
        "ticks at the end of the range, by joint",
        "1",
        JOINTS,
        INT,
        optional=True,
        name="at_stop_by",
    ),
    Column("saturation.peak_torque", "peak torque over maximum torque", "1", JOINTS, optional=True),
    Column("saturation.peak_speed", "peak speed", "rad/s", JOINTS, optional=True),
)

EVENT = Row(
    "Event.",
    Column("time", "simulated time", "s"),
    Column(
        "kind",
        "fault, push, collision, fall, via_point, goal, lost, relocalized or diverged",
        type=TEXT,
    ),
    Column("text", "description", type=TEXT),
)

IMAGE = Row(
    "Image of the head camera.",
    Column("index", "number of its frame", type=INT),
    Column("time", "time at which the frame reached the robot", "s"),
    Column("captured", "time at which the image was taken", "s"),
    Column("jpeg", "the image", type=BYTES),
)

COMMAND = Row(
    "Command from outside (option `--ros-drive`), NaN where it commands nothing. A driven run has "
    "at least one.",
    Column("time", "time of the control tick after which it is in force", "s"),
    Column("velocity", "velocity vx, vy, wz in R", VELOCITY, (3,)),
    Column("gaze", "pan and tilt", "rad", (2,)),
)

TABLES = {
    "ticks": TICK,
    "records": RECORD,
    "frames": FRAME,
    "seconds": SECOND,
    "events": EVENT,
    "images": IMAGE,
    "commands": COMMAND,
}
