"""Conversion of the states that the loop publishes into rows of tables."""

from math import nan

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.frame_record import FrameRecord, Image
from hsr8.record import Second, Tick, TickRecord
from hsr8.recorder import rows
from hsr8.recorder.fingerprints import decision_fingerprints, fingerprints
from hsr8.recorder.sampled_field import NO_FIELD, SampledField, sampled
from hsr8.recorder.throttle import Throttle
from navigation.belief.belief import Belief, Track
from navigation.decision import GazeDecision, MotionDecision
from walking.command_limits import Limit

Array = NDArray[np.float64]

LIMITS = tuple(Limit)
"""Limits in the order of their bits."""
MAP_PERIOD = 1.0  # between two local maps, particle clouds or fields [s]
BITS = {limit: 1 << k for k, limit in enumerate(LIMITS)}
UNKNOWN = np.full(3, nan)


def tick_row(tick: Tick) -> rows.TickRow:
    """Return the row of one control tick."""
    sensors = tick.sensors
    return rows.TickRow(
        tick=tick.number,
        time=tick.time,
        joint_position=sensors.joint_position,
        joint_velocity=sensors.joint_velocity,
        gyro=sensors.gyro,
        accelerometer=sensors.accelerometer,
        orientation=sensors.orientation,
        foot_force=sensors.foot_force,
        setpoint=tick.setpoint,
        limits=limit_bits(tick.limits),
        zmp_depth=tick.zmp_depth,
        down=tick.down,
        walking_time=tick.walking_time,
    )


def record_row(record: TickRecord) -> rows.RecordRow:
    """Return the row of a record."""
    truth, walking = record.truth, record.walking
    odometry, camera, balance = walking.odometry, walking.camera, walking.balance
    report = walking.command_limits
    return rows.RecordRow(
        tick=record.tick,
        time=record.time,
        qpos=truth.qpos,
        robot=truth.robot,
        obstacle_positions=truth.obstacle_positions,
        obstacle_velocities=truth.obstacle_velocities,
        clearance=truth.clearance,
        joint_torque=truth.joint_torque,
        foot_load=truth.foot_force,
        cop=truth.zmp,
        fallen=truth.fallen,
        contacts=truth.contacts,
        pushes=truth.pushes,
        phase=walking.phase,
        odometry=(odometry.x, odometry.y, odometry.yaw),
        odometry_covariance=odometry.covariance,
        camera_rotation=camera.rotation,
        camera_position=camera.position,
        head=(camera.pan, camera.tilt),
        head_rate=(camera.pan_rate, camera.tilt_rate),
        head_target=(record.head.pan, record.head.tilt),
        command=record.command.velocity,
        applied_velocity=walking.applied_velocity,
        limited_command=UNKNOWN if report is None else report.commanded.velocity,
        limits=0 if report is None else limit_bits(report.limits),
        footsteps=walking.footsteps,
        step_count=walking.step_count,
        zmp=walking.zmp,
        com=balance.com,
        measured_com=walking.com,
        dcm=walking.dcm,
        measured_dcm=balance.dcm,
        support=balance.support,
        zmp_depth=balance.zmp_depth,
        feet=balance.feet,
        capture=balance.capture,
        roll=walking.roll,
        pitch=walking.pitch,
        believes_fallen=walking.fallen,
    )


class FrameRows:
    """Conversion of camera frames: what changes rarely is recorded when it is new.

    Args:
        scale: of the world [1].
    """

    def __init__(self, scale: float = 1.0) -> None:
        self._scale = scale
        self._gaze_map: Array | None = None
        self._motion: MotionDecision | None = None
        self._maps, self._fields = Throttle(MAP_PERIOD), Throttle(MAP_PERIOD)

    def row(self, frame: FrameRecord) -> rows.FrameRow:
        """Return the row of a camera frame."""
        measured, context, decision = frame.measured, frame.context, frame.decision
        belief, task, motion, gaze = frame.belief, frame.task, frame.motion, frame.gaze
        planned, self._motion = motion is not self._motion, motion
        maps = self._maps.due(frame.time)
        field = self._field(frame) if planned else NO_FIELD
        estimate = fingerprints(frame.estimate)
        known = estimate if frame.belief is frame.estimate else None
        return rows.FrameRow(
            index=frame.index,
            time=frame.time,
            captured=measured.time,
            capture_odometry=measured.odometry,
            motion_covariance=measured.motion_covariance,
            capture_rotation=measured.view.rotation,
            capture_position=measured.view.position,
            capture_head=(measured.view.pan, measured.view.tilt),
            detections=frame.detections,
            odometry=context.odometry,
            camera_rotation=context.view.rotation,
            camera_position=context.view.position,
            head=(context.view.pan, context.view.tilt),
            fov=(context.view.horizontal_fov, context.view.vertical_fov),
            yaw_sigma=context.view.yaw_sigma,
            step_count=context.step_count,
            pose=belief.pose,
            pose_covariance=belief.pose_covariance,
            lost=belief.lost,
            filter_faults=belief.filter_faults,
            seen_beacons=belief.seen_beacons,
            tracks=[_track_row(track) for track in belief.tracks],
            target=task.target,
            target_heading=task.heading,
            is_goal=task.is_goal,
            via_points=task.index,
            aligning=task.aligning,
            done=task.done,
            planned=planned,
            first_plan=decision.fresh,
            velocity=motion.velocity,
            direction=motion.direction,
            speed=motion.speed,
            situation=motion.situation,
            look_request=motion.look_request,
            virtual_obstacles=motion.virtual_obstacles,
            gaze=(gaze.pan, gaze.tilt),
            body_direction=gaze.body_direction,
            psi=(gaze.psi_lm, gaze.psi_sf, gaze.psi_ob, gaze.psi_way),
            gaze_map=self._shades(gaze),
            local_map=confidence_shades(belief) if maps else None,
            map_origin=belief.local_map.origin,
            map_cell=belief.local_map.cell,
            particles=_particle_rows(belief) if maps else (),
            field_points=field.points,
            field_directions=field.directions,
            field_path=field.path,
            fingerprints=b"".join([*estimate, *decision_fingerprints(decision, known)]),
        )

    def _shades(self, gaze: GazeDecision) -> NDArray[np.uint8] | None:
        """Return a new gaze map in shades; None for the same map and for a gaze without one."""
        gaze_map = gaze.gaze_map
        if gaze_map is self._gaze_map or gaze_map.size <= 1:
            return None
        self._gaze_map = gaze_map
        top = float(gaze_map.max())
        return np.round(gaze_map * (255.0 / top if top > 0.0 else 0.0)).astype(np.uint8)

    def _field(self, frame: FrameRecord) -> SampledField:
        if frame.motion.field is None or not self._fields.due(frame.time):
            return NO_FIELD
        return sampled(frame.motion.field, frame.belief.pose[:2], frame.task.target, self._scale)


def second_row(second: Second) -> rows.SecondRow:
    """Return the row of hashes and counters."""
    row = rows.SecondRow(second.tick, second.time, second.world, second.robot)
    if (saturation := second.saturation) is not None:
        row.torque_saturated = saturation.torque_any
        row.torque_saturated_by = saturation.torque_ticks
        row.at_stop, row.at_stop_by = saturation.stop_any, saturation.stop_ticks
        row.peak_torque, row.peak_speed = saturation.peak_torque, saturation.peak_speed
    return row


def image_row(frame: FrameRecord, image: Image, quality: int) -> rows.ImageRow:
    """Return the row of an image, compressed with a `quality` [%]."""
    bgr = cv2.cvtColor(image, cv2.COLOR_RGB2BGR)
    jpeg = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes()
    return rows.ImageRow(frame.index, frame.time, frame.measured.time, jpeg)


def limit_bits(limits: tuple[Limit, ...]) -> int:
    """Return the active limits of a command, one bit each."""
    bits = 0
    for limit in limits:
        bits |= BITS[limit]
    return bits


def confidence_shades(belief: Belief) -> NDArray[np.uint8]:
    """Return the confidence of the local map in 255 shades."""
    return np.round(255.0 * belief.local_map.confidence).astype(np.uint8)


def _track_row(track: Track) -> rows.TrackRow:
    return rows.TrackRow(
        id=track.id,
        label=track.label,
        position=track.position,
        velocity=track.velocity,
        covariance=track.covariance,
        radius=track.radius,
        radius_sigma=track.radius_sigma,
        motion=track.motion,
        hits=track.hits,
        age=track.age,
        last_seen=track.last_seen,
        visible=track.visible,
        lost=track.particles is not None,
        reach=track.reach,
        turn_rate=track.turn_rate,
    )


def _particle_rows(belief: Belief) -> list[rows.ParticleRow]:
    return [
        rows.ParticleRow(track.label, position, len(cloud.weights) * weight)
        for track in belief.tracks
        if (cloud := track.particles) is not None
        for position, weight in zip(cloud.positions, cloud.weights.tolist(), strict=True)
    ]
