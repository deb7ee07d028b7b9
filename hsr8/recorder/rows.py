"""Rows of the tables of a run: what is recorded, with units, and its source.

Poses are those of the robot frame R: x, y, heading [m, m, rad]. W is the world frame. Quantities
"in odometry" are in the odometry frame of the robot, which drifts.
"""

from collections.abc import Callable, Sequence
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsr8.record import Second
from hsr8.recorder.columns import at, computed, row
from hsr8.recorder.limit_bits import limit_bits, limited_command_of, limits_of
from hsr8.world.truth.truth import ActivePush, Contact
from navigation.decision import VirtualObstacle
from vision.detection import Detection
from walking.foothold import Foothold
from walking.value import value

Array = NDArray[np.float64]
Vector = Array | tuple[float, ...]
Shades = NDArray[np.uint8]


def _saturation(name: str) -> Callable[[Second], Any]:
    """Return the source of a counter of saturation, which a body without dynamics lacks."""
    counter = attrgetter(name)
    return lambda second: None if second.saturation is None else counter(second.saturation)


@row
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

    tick: int = at("number")
    time: float
    joint_position: Array = at("sensors.joint_position")
    joint_velocity: Array = at("sensors.joint_velocity")
    gyro: Array = at("sensors.gyro")
    accelerometer: Array = at("sensors.accelerometer")
    orientation: Array = at("sensors.orientation")
    foot_force: Array = at("sensors.foot_force")
    setpoint: Array
    limits: int = computed(lambda tick: limit_bits(tick.limits))
    zmp_depth: float
    down: bool
    walking_time: float


@row
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
    qpos: Array = at("truth.qpos")
    robot: Array = at("truth.robot")
    obstacle_positions: Array = at("truth.obstacle_positions")
    obstacle_velocities: Array = at("truth.obstacle_velocities")
    clearance: float = at("truth.clearance")
    joint_torque: Array = at("truth.joint_torque")
    foot_load: Array = at("truth.foot_force")
    cop: Array = at("truth.zmp")
    fallen: bool = at("truth.fallen")
    contacts: tuple[Contact, ...] = at("truth.contacts")
    pushes: tuple[ActivePush, ...] = at("truth.pushes")
    phase: str = at("walking.phase")
    odometry: Vector = at("walking.odometry.x", "walking.odometry.y", "walking.odometry.yaw")
    odometry_covariance: Array = at("walking.odometry.covariance")
    camera_rotation: Array = at("walking.camera.rotation")
    camera_position: Array = at("walking.camera.position")
    head: Vector = at("walking.camera.pan", "walking.camera.tilt")
    head_rate: Vector = at("walking.camera.pan_rate", "walking.camera.tilt_rate")
    head_target: Vector = at("head.pan", "head.tilt")
    command: Vector = at("command.velocity")
    applied_velocity: Array = at("walking.applied_velocity")
    limited_command: Vector = computed(limited_command_of)
    limits: int = computed(limits_of)
    footsteps: tuple[Foothold, ...] = at("walking.footsteps")
    step_count: int = at("walking.step_count")
    zmp: Array = at("walking.zmp")
    com: Array = at("walking.balance.com")
    measured_com: Array = at("walking.com")
    dcm: Array = at("walking.dcm")
    measured_dcm: Array = at("walking.balance.dcm")
    support: Array = at("walking.balance.support")
    zmp_depth: float = at("walking.balance.zmp_depth")
    feet: Array = at("walking.balance.feet")
    capture: Array = at("walking.balance.capture")
    roll: float = at("walking.roll")
    pitch: float = at("walking.pitch")
    believes_fallen: bool = at("walking.fallen")


@row
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
    lost: bool = computed(lambda track: track.particles is not None)
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


@row
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
        capture_head_rate: measured rates of pan and tilt at the capture (2,) [rad/s].
        capture_blind: whether the camera turned too fast at the capture to see anything.
        detections: in the image.
        odometry: pose in odometry at `time` (3,) [m, m, rad].
        camera_rotation: R_RC at `time` (3, 3) [1].
        camera_position: p_RC at `time` (3,) [m].
        head: measured pan and tilt at `time` (2,) [rad].
        head_rate: measured rates of pan and tilt at `time` (2,) [rad/s].
        blind: whether the camera turned too fast at `time`.
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
        virtual_obstacles: in the field.
        gaze: decided pan and tilt (2,) [rad].
        stabilized: whether the gaze keeps its direction in W while the body turns.
        body_direction: direction in W that the body turns to for a fixed camera [rad].
        psi: partial evaluations of local map, self, obstacle and way (4,) [1].
        gaze_map: gaze map GM in 255 shades of its maximum, from below and from the right
            (tilts, pans) [1].
        local_map: confidence in 255 shades, from minimum y and minimum x (rows, columns) [1].
        map_hash: hash of the whole local map, recorded with it.
        map_origin: corner of minimum x and y of the local map in W (2,) [m].
        map_cell: side of a cell of the local map [m].
        particles: of lost movers.
        field_points: points in W at which the direction field is sampled (n, 2) [m].
        field_directions: unit vectors there (n, 2) [1].
        field_path: path along the field in W (n, 2) [m].
    """

    index: int = at("frame.index")
    time: float = at("frame.time")
    captured: float = at("frame.measured.time")
    capture_odometry: Array = at("frame.measured.odometry")
    motion_covariance: Array = at("frame.measured.motion_covariance")
    capture_rotation: Array = at("frame.measured.view.rotation")
    capture_position: Array = at("frame.measured.view.position")
    capture_head: Vector = at("frame.measured.view.pan", "frame.measured.view.tilt")
    capture_head_rate: Vector = at("frame.measured.view.pan_rate", "frame.measured.view.tilt_rate")
    capture_blind: bool = at("frame.measured.view.blind")
    detections: tuple[Detection, ...] = at("frame.detections")
    odometry: Array = at("frame.context.odometry")
    camera_rotation: Array = at("frame.context.view.rotation")
    camera_position: Array = at("frame.context.view.position")
    head: Vector = at("frame.context.view.pan", "frame.context.view.tilt")
    head_rate: Vector = at("frame.context.view.pan_rate", "frame.context.view.tilt_rate")
    blind: bool = at("frame.context.view.blind")
    fov: Vector = at("frame.context.view.horizontal_fov", "frame.context.view.vertical_fov")
    yaw_sigma: float = at("frame.context.view.yaw_sigma")
    step_count: int = at("frame.context.step_count")
    pose: Array = at("frame.decision.belief.pose")
    pose_covariance: Array = at("frame.decision.belief.pose_covariance")
    lost: bool = at("frame.decision.belief.lost")
    filter_faults: int = at("frame.decision.belief.filter_faults")
    seen_beacons: tuple[str, ...] = at("frame.decision.belief.seen_beacons")
    tracks: Sequence[TrackRow] = at("frame.decision.belief.tracks")
    target: Array = at("frame.decision.task.target")
    target_heading: float = at("frame.decision.task.heading")
    is_goal: bool = at("frame.decision.task.is_goal")
    via_points: int = at("frame.decision.task.index")
    aligning: bool = at("frame.decision.task.aligning")
    done: bool = at("frame.decision.task.done")
    planned: bool
    first_plan: bool = at("frame.decision.fresh")
    velocity: Array = at("frame.decision.motion.velocity")
    direction: float = at("frame.decision.motion.direction")
    speed: float = at("frame.decision.motion.speed")
    situation: str = at("frame.decision.motion.situation")
    virtual_obstacles: tuple[VirtualObstacle, ...] = at("frame.decision.motion.virtual_obstacles")
    gaze: Vector = at("frame.decision.gaze.pan", "frame.decision.gaze.tilt")
    stabilized: bool = at("frame.decision.gaze.stabilized")
    body_direction: float | None = at("frame.decision.gaze.body_direction")
    psi: Vector = at(*(f"frame.decision.gaze.psi_{name}" for name in ("lm", "sf", "ob", "way")))
    gaze_map: Shades | None
    local_map: Shades | None
    map_hash: bytes | None
    map_origin: Vector = at("frame.decision.belief.local_map.origin")
    map_cell: float = at("frame.decision.belief.local_map.cell")
    particles: Sequence[ParticleRow]
    field_points: Array = at("field.points")
    field_directions: Array = at("field.directions")
    field_path: Array = at("field.path")


@row
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
    torque_saturated: int | None = computed(_saturation("torque_any"))
    torque_saturated_by: NDArray[np.int64] | None = computed(_saturation("torque_ticks"))
    at_stop: int | None = computed(_saturation("stop_any"))
    at_stop_by: NDArray[np.int64] | None = computed(_saturation("stop_ticks"))
    peak_torque: Array | None = computed(_saturation("peak_torque"))
    peak_speed: Array | None = computed(_saturation("peak_speed"))


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
