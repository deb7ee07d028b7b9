"""Rows of the tables of a run: what is recorded, with units.

Poses are those of the robot frame R: x, y, heading [m, m, rad]. W is the world frame. Quantities
"in odometry" are in the odometry frame of the robot, which drifts.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsr8.world.truth.truth import ActivePush, Contact
from navigation.decision import VirtualObstacle
from vision.detection import Detection
from walking.foothold import Foothold
from walking.value import value

Array = NDArray[np.float64]
Vector = Array | tuple[float, ...]
Shades = NDArray[np.uint8]


@value
class TickRow:
    """Sensors, as the robot receives them, and setpoints of one control tick.

    Attributes:
        tick: number of the control tick.
        time: simulated time [s].
        joint_position: encoder angles (joints,) [rad].
        joint_velocity: encoder rates (joints,) [rad/s].
        gyro: angular velocity of the trunk in the IMU frame (3,) [rad/s].
        accelerometer: specific force in the IMU frame (3,) [m/s²].
        orientation: attitude of the IMU, quaternion w-x-y-z (4,) [1].
        foot_force: force under the front-left, front-right, back-left and back-right pad of the
            left and the right foot (2, 4) [N].
        setpoint: of the servos; NaN in the last tick, whose setpoints are not sent (joints,) [rad].
        limits: active limits of the command, bit k for limit k of `walking.command_limits.Limit`.
        zmp_depth: distance of the planned ZMP from the edge of the soles, negative outside [m].
        down: whether the robot lies or gets up.
        walking_time: wall time of the walking engine, the only column that differs between
            repeated runs [s].
    """

    tick: int
    time: float
    joint_position: Array
    joint_velocity: Array
    gyro: Array
    accelerometer: Array
    orientation: Array
    foot_force: Array
    setpoint: Array
    limits: int
    zmp_depth: float
    down: bool
    walking_time: float


@value
class RecordRow:
    """True state of the world and state of the walking engine, every 20 ms.

    Attributes:
        tick: number of the control tick.
        time: simulated time [s].
        qpos: true generalised position of the robot, MuJoCo order (nq,) [m, rad].
        robot: true pose (3,) [m, m, rad].
        obstacle_positions: axes of all obstacles in W, layout order (obstacles, 2) [m].
        obstacle_velocities: of the axes in W (obstacles, 2) [m/s].
        clearance: true distance of the robot to the nearest obstacle or beacon [m].
        joint_torque: true torque (joints,) [N m].
        foot_load: true normal force under the left and right foot (2,) [N].
        cop: true centre of pressure under both feet in W, NaN when airborne (2,) [m].
        fallen: whether the robot has fallen.
        contacts: since the previous row.
        pushes: active since the previous row.
        phase: gait phase.
        odometry: pose in odometry, heading unwrapped (3,) [m, m, rad].
        odometry_covariance: of its error, see `walking.body.odometry` (3, 3) [m, rad].
        camera_rotation: R_RC, columns are the camera's right, down and forward axes (3, 3) [1].
        camera_position: p_RC (3,) [m].
        head: measured pan and tilt (2,) [rad].
        head_rate: measured rates of pan and tilt (2,) [rad/s].
        head_target: commanded pan and tilt (2,) [rad].
        command: commanded velocity vx, vy, wz (3,) [m/s, m/s, rad/s].
        applied_velocity: velocity that the footsteps follow (3,) [m/s, m/s, rad/s].
        limited_command: command that `limits` refer to, NaN before the first
            (3,) [m/s, m/s, rad/s].
        limits: active limits of the command, bit k for limit k of `walking.command_limits.Limit`.
        footsteps: planned footholds in odometry, the support foot first.
        step_count: completed steps.
        zmp: planned zero-moment point in odometry (2,) [m].
        com: planned centre of mass in odometry (2,) [m].
        measured_com: measured centre of mass in odometry (2,) [m].
        dcm: planned divergent component of motion in odometry (2,) [m].
        measured_dcm: measured divergent component of motion in odometry (2,) [m].
        support: corners of the planned support polygon in odometry, counter-clockwise (n, 2) [m].
        zmp_depth: distance of the planned ZMP from the edge of the soles, negative outside [m].
        feet: references of the left and right foot in odometry: x, y, height, yaw (2, 4) [m, rad].
        capture: shift of the landing by the capture step in odometry (2,) [m].
        roll, pitch: measured attitude of the trunk [rad].
        believes_fallen: whether the robot believes that it has fallen.
    """

    tick: int
    time: float
    qpos: Array
    robot: Array
    obstacle_positions: Array
    obstacle_velocities: Array
    clearance: float
    joint_torque: Array
    foot_load: Array
    cop: Array
    fallen: bool
    contacts: tuple[Contact, ...]
    pushes: tuple[ActivePush, ...]
    phase: str
    odometry: Vector
    odometry_covariance: Array
    camera_rotation: Array
    camera_position: Array
    head: Vector
    head_rate: Vector
    head_target: Vector
    command: Vector
    applied_velocity: Array
    limited_command: Vector
    limits: int
    footsteps: tuple[Foothold, ...]
    step_count: int
    zmp: Array
    com: Array
    measured_com: Array
    dcm: Array
    measured_dcm: Array
    support: Array
    zmp_depth: float
    feet: Array
    capture: Array
    roll: float
    pitch: float
    believes_fallen: bool


@value
class TrackRow:
    """Believed obstacle.

    Attributes:
        id: number, unique in a run.
        label: colour class.
        position: in W (2,) [m].
        velocity: in W (2,) [m/s].
        covariance: of x, y, vx, vy (4, 4) [m, m/s].
        radius: of its cylinder [m].
        radius_sigma: standard deviation of `radius` [m].
        motion: static, moving or unknown.
        hits: number of detections.
        age: time from its last detection to the capture [s].
        last_seen: position of its last detection in W (2,) [m].
        visible: whether it was detected in this frame.
        lost: whether particles represent it.
        reach: radius of the disc around `last_seen` that it can have reached [m].
        turn_rate: left positive [rad/s].
    """

    id: int
    label: str
    position: Array
    velocity: Array
    covariance: Array
    radius: float
    radius_sigma: float
    motion: str
    hits: int
    age: float
    last_seen: Array
    visible: bool
    lost: bool
    reach: float
    turn_rate: float


@value
class ParticleRow:
    """Particle of a lost mover.

    Attributes:
        label: colour class of its track.
        position: in W (2,) [m].
        weight: relative to the mean weight of the track [1].
    """

    label: str
    position: Array
    weight: float


@value
class FrameRow:
    """Detections, belief and decisions of one camera frame.

    The local map, the particles and the field are recorded about once per second, the gaze map when
    it is new.

    Attributes:
        index: number of the frame.
        time: when the frame reached the robot [s].
        captured: when the image was taken [s].
        capture_odometry: pose in odometry at the capture (3,) [m, m, rad].
        motion_covariance: of the motion since the previous frame (3, 3) [m, rad].
        capture_rotation: R_RC at the capture (3, 3) [1].
        capture_position: p_RC at the capture (3,) [m].
        capture_head: measured pan and tilt at the capture (2,) [rad].
        detections: in the image.
        odometry: pose in odometry at `time` (3,) [m, m, rad].
        camera_rotation: R_RC at `time` (3, 3) [1].
        camera_position: p_RC at `time` (3,) [m].
        head: measured pan and tilt at `time` (2,) [rad].
        fov: horizontal and vertical field of view (2,) [rad].
        yaw_sigma: standard deviation of the camera's yaw [rad].
        step_count: completed steps at `time`.
        pose: believed pose at `time` (3,) [m, m, rad].
        pose_covariance: of `pose` (3, 3) [m, rad].
        lost: whether localization reports being lost.
        filter_faults: re-initializations of the pose filter so far.
        seen_beacons: names of the beacons in the frame.
        tracks: believed obstacles.
        target: destination in W (2,) [m].
        target_heading: heading to arrive with [rad].
        is_goal: whether the target is the goal, not a via point.
        via_points: passed so far.
        aligning: whether the robot is at the goal and turns to its heading.
        done: whether the mission is finished.
        planned: whether the motion was decided in this frame.
        first_plan: whether no earlier motion was in force.
        velocity: decided velocity vx, vy, wz in R (3,) [m/s, m/s, rad/s].
        direction: of motion in W [rad].
        speed: along `direction` [m/s].
        situation: outcome of velocity modification.
        look_request: direction in W that the rear check turns to [rad].
        virtual_obstacles: in the field.
        gaze: decided pan and tilt (2,) [rad].
        body_direction: direction in W that the body turns to for a fixed camera [rad].
        psi: partial evaluations of local map, self, obstacle and way (4,) [1].
        gaze_map: gaze map GM in 255 shades of its maximum, from below and from the right
            (tilts, pans) [1].
        local_map: confidence in 255 shades, from minimum y and minimum x (rows, columns) [1].
        map_origin: corner of minimum x and y of the local map in W (2,) [m].
        map_cell: side of a cell of the local map [m].
        particles: of lost movers.
        field_points: points in W at which the direction field is sampled (n, 2) [m].
        field_directions: unit vectors there (n, 2) [1].
        field_path: path along the field in W (n, 2) [m].
        fingerprints: 8 bytes for each channel of `hsr8.recorder.fingerprints`.
    """

    index: int
    time: float
    captured: float
    capture_odometry: Array
    motion_covariance: Array
    capture_rotation: Array
    capture_position: Array
    capture_head: Vector
    detections: tuple[Detection, ...]
    odometry: Array
    camera_rotation: Array
    camera_position: Array
    head: Vector
    fov: Vector
    yaw_sigma: float
    step_count: int
    pose: Array
    pose_covariance: Array
    lost: bool
    filter_faults: int
    seen_beacons: tuple[str, ...]
    tracks: Sequence[TrackRow]
    target: Array
    target_heading: float
    is_goal: bool
    via_points: int
    aligning: bool
    done: bool
    planned: bool
    first_plan: bool
    velocity: Array
    direction: float
    speed: float
    situation: str
    look_request: float | None
    virtual_obstacles: tuple[VirtualObstacle, ...]
    gaze: Vector
    body_direction: float | None
    psi: Vector
    gaze_map: Shades | None
    local_map: Shades | None
    map_origin: Vector
    map_cell: float
    particles: Sequence[ParticleRow]
    field_points: Array
    field_directions: Array
    field_path: Array
    fingerprints: bytes


@dataclass(slots=True, eq=False)
class SecondRow:
    """Hashes of the state and saturation of the servos so far, every second and at the end.

    Attributes:
        tick: number of the next control tick.
        time: simulated time [s].
        world: hash of the state of the world.
        robot: hash of the state of the world and the belief.
        torque_saturated: ticks with a joint at its maximum torque.
        torque_saturated_by: the same by joint (joints,) [1].
        at_stop: ticks with a joint at the end of its range.
        at_stop_by: the same by joint (joints,) [1].
        peak_torque: peak torque over maximum torque (joints,) [1].
        peak_speed: peak speed (joints,) [rad/s].
    """

    tick: int
    time: float
    world: bytes
    robot: bytes
    torque_saturated: int | None = None
    torque_saturated_by: NDArray[np.int64] | None = None
    at_stop: int | None = None
    at_stop_by: NDArray[np.int64] | None = None
    peak_torque: Array | None = None
    peak_speed: Array | None = None


@value
class EventRow:
    """Event.

    Attributes:
        time: simulated time [s].
        kind: fault, push, collision, fall, via_point, goal, lost, relocalized or diverged.
        text: description.
    """

    time: float
    kind: str
    text: str


@value
class ImageRow:
    """Image of the head camera.

    Attributes:
        index: number of its frame.
        time: when the frame reached the robot [s].
        captured: when the image was taken [s].
        jpeg: the image.
    """

    index: int
    time: float
    captured: float
    jpeg: bytes


TABLES: dict[str, type[Any]] = {
    "ticks": TickRow,
    "records": RecordRow,
    "frames": FrameRow,
    "seconds": SecondRow,
    "events": EventRow,
    "images": ImageRow,
}
