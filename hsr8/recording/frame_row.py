"""Row of a camera frame: detections, belief and decisions, with the objects in its columns."""

from collections.abc import Sequence
from math import inf
from typing import Any

import numpy as np

from hsr8.recording.columns import BOOL, BYTES, INT, SHADE, TEXT, VARYING, Column, Row

POSE, VELOCITY, POSE_COVARIANCE = "m, m, rad", "m/s, m/s, rad/s", "m, rad"
MEASURED, CONTEXT = "frame.measured", "frame.context"
BELIEF, TASK, MOTION, GAZE = (
    f"frame.decision.{part}" for part in ("belief", "task", "motion", "gaze")
)


def camera_columns(path: str, when: str, camera: str, head: str) -> tuple[Column, ...]:
    """Return the columns of the pose of the camera and the head.

    Args:
        path: path of attributes to the view.
        when: end of the descriptions.
        camera: beginning of the names of rotation and position.
        head: name of pan and tilt, and beginning of that of their rates.
    """
    pan_tilt, rates = (f"{path}.pan", f"{path}.tilt"), (f"{path}.pan_rate", f"{path}.tilt_rate")
    axes = f"R_RC{when}, columns are the camera's right, down and forward axes"
    return (
        Column(f"{path}.rotation", axes, "1", (3, 3), name=f"{camera}_rotation"),
        Column(f"{path}.position", f"p_RC{when}", "m", (3,), name=f"{camera}_position"),
        Column(pan_tilt, f"measured pan and tilt{when}", "rad", (2,), name=head),
        Column(rates, f"measured rates of pan and tilt{when}", "rad/s", (2,), name=f"{head}_rate"),
    )


def _nearest_track(recorded: Any) -> float:
    """Return the distance of a `RecordedFrame`."""
    tracks, position = recorded.tracks, recorded.frame.belief.pose[:2]
    distances = np.hypot(*(tracks.position - position).T) - tracks.radius
    return float(distances.min(initial=inf))


def _track_arrays(sets: Sequence[Any]) -> dict[str, Any]:
    """Return the tracks of several `navigation.belief.tracks.Tracks` by column of `TRACK`."""
    from navigation.belief.tracks import MOTIONS  # noqa: PLC0415  reading a run needs no robot

    rows = np.concatenate([tracks.rows for tracks in sets])
    labels = [tracks.labels[k] for tracks in sets for k in tracks.rows["label"].tolist()]
    names = (column.name for column in TRACK.columns if column.name != "lost")
    return {name: rows[name] for name in names} | {
        "label": labels,
        "motion": [MOTIONS[k] for k in rows["motion"].tolist()],
        "lost": rows["cloud"] >= 0,
    }


DETECTION = Row(
    "Cylinder detected in an image, in the robot frame R at the capture.",
    Column("kind", "obstacle or beacon", type=TEXT),
    Column(
        "label", "colour class of an obstacle; ``top/bottom`` colour classes of a beacon", type=TEXT
    ),
    Column("bearing", "direction of the axis, counter-clockwise from x of R", "rad"),
    Column("distance", "horizontal distance of the axis from the origin of R", "m"),
    Column("covariance", "covariance of (distance, bearing)", "m², m rad, rad²", (2, 2)),
    Column("radius", "radius of the cylinder", "m"),
    Column("radius_sigma", "standard deviation of `radius`", "m"),
    Column(
        "by_radius",
        "partial derivatives of (distance, bearing) with respect to the radius",
        "1, rad/m",
        (2,),
    ),
    Column("cut", "whether the blob touches the border of the image or the self mask", type=BOOL),
    Column("occluded", "whether the cylinder is partly occluded", type=BOOL),
    Column(
        "box",
        "left, top, right, bottom pixel of the blob, right and bottom exclusive",
        shape=(4,),
        type=INT,
    ),
)

TRACK = Row(
    "Believed obstacle.",
    Column("id", "number, unique in a run", type=INT),
    Column("label", "colour class", type=TEXT),
    Column("position", "position in W", "m", (2,)),
    Column("velocity", "velocity in W", "m/s", (2,)),
    Column("covariance", "covariance of x, y, vx, vy", "m, m/s", (4, 4)),
    Column("radius", "radius of its cylinder", "m"),
    Column("radius_sigma", "standard deviation of `radius`", "m"),
    Column("motion", "static, moving or unknown", type=TEXT),
    Column("hits", "number of detections", type=INT),
    Column("age", "time from its last detection to the capture", "s"),
    Column("last_seen", "position of its last detection in W", "m", (2,)),
    Column("visible", "whether it was detected in this frame", type=BOOL),
    Column("lost", "whether particles represent it", type=BOOL),
    Column("reach", "radius of the disc around `last_seen` that it can have reached", "m"),
    Column("turn_rate", "turn rate, left positive", "rad/s"),
)

VIRTUAL_OBSTACLE = Row(
    "Dynamic virtual obstacle (Yoo & Kim, eq. (11)).",
    Column("position", "p_vo in W", "m", (2,)),
    Column("radius", "R_vo", "m"),
    Column("track_id", "number of the track of its mover", type=INT),
)

PARTICLE = Row(
    "Particle of a lost mover.",
    Column("label", "colour class of its track", type=TEXT),
    Column("position", "position in W", "m", (2,)),
    Column("weight", "weight relative to the mean weight of the track", "1"),
)

FRAME = Row(
    "Detections, belief and decisions of one camera frame. The local map, the particles and the "
    "field are recorded about once per second, the gaze map when it is new.",
    Column("frame.index", "number of the frame", type=INT),
    Column(f"{CONTEXT}.time", "time at which the frame reached the robot", "s"),
    Column(f"{MEASURED}.time", "time at which the image was taken", "s", name="captured"),
    Column(
        f"{MEASURED}.odometry",
        "pose in odometry at the capture",
        POSE,
        (3,),
        name="capture_odometry",
    ),
    Column(
        f"{MEASURED}.motion_covariance",
        "covariance of the motion since the previous frame",
        POSE_COVARIANCE,
        (3, 3),
    ),
    *camera_columns(f"{MEASURED}.view", " at the capture", "capture", "capture_head"),
    Column(
        f"{MEASURED}.view.blind",
        "whether the camera turned too fast at the capture to see anything",
        type=BOOL,
        name="capture_blind",
    ),
    Column("frame.detections", "detections in the image", items=DETECTION),
    Column(f"{CONTEXT}.odometry", "pose in odometry at `time`", POSE, (3,)),
    *camera_columns(f"{CONTEXT}.view", " at `time`", "camera", "head"),
    Column(f"{CONTEXT}.view.blind", "whether the camera turned too fast at `time`", type=BOOL),
    Column(
        (f"{CONTEXT}.view.model.horizontal_fov", f"{CONTEXT}.view.model.vertical_fov"),
        "horizontal and vertical field of view",
        "rad",
        (2,),
        name="fov",
    ),
    Column(f"{CONTEXT}.view.model.yaw_sigma", "standard deviation of the camera's yaw", "rad"),
    Column(f"{CONTEXT}.step_count", "completed steps at `time`", type=INT),
    Column(f"{BELIEF}.pose", "believed pose at `time`", POSE, (3,)),
    Column(f"{BELIEF}.pose_covariance", "covariance of `pose`", POSE_COVARIANCE, (3, 3)),
    Column(f"{BELIEF}.lost", "whether localization reports being lost", type=BOOL),
    Column(f"{BELIEF}.filter_faults", "re-initializations of the pose filter so far", type=INT),
    Column(
        f"{BELIEF}.seen_beacons", "names of the beacons in the frame", shape=(VARYING,), type=TEXT
    ),
    Column("tracks", "believed obstacles", items=TRACK, arrays=_track_arrays),
    Column(
        _nearest_track,
        "distance of the robot axis to the nearest believed obstacle, infinite without one",
        "m",
        name="nearest_track",
    ),
    Column(f"{TASK}.target", "destination in W", "m", (2,)),
    Column(f"{TASK}.heading", "heading to arrive with", "rad", name="target_heading"),
    Column(f"{TASK}.is_goal", "whether the target is the goal, not a via point", type=BOOL),
    Column(f"{TASK}.index", "number of via points passed so far", type=INT, name="via_points"),
    Column(
        f"{TASK}.aligning", "whether the robot is at the goal and turns to its heading", type=BOOL
    ),
    Column(f"{TASK}.done", "whether the mission is finished", type=BOOL),
    Column("planned", "whether the motion was decided in this frame", type=BOOL),
    Column(
        "frame.decision.fresh",
        "whether no earlier motion was in force",
        type=BOOL,
        name="first_plan",
    ),
    Column(f"{MOTION}.velocity", "decided velocity vx, vy, wz in R", VELOCITY, (3,)),
    Column(f"{MOTION}.direction", "direction of motion in W", "rad"),
    Column(f"{MOTION}.speed", "speed that the planner desires along `direction`", "m/s"),
    Column(
        f"{MOTION}.situation",
        "free; veto of the safety filter; or outcome of the paper's velocity modification",
        type=TEXT,
    ),
    Column(
        f"{MOTION}.virtual_obstacles",
        "virtual obstacles in the field of the method of the paper",
        items=VIRTUAL_OBSTACLE,
    ),
    Column((f"{GAZE}.pan", f"{GAZE}.tilt"), "decided pan and tilt", "rad", (2,), name="gaze"),
    Column(
        f"{GAZE}.stabilized",
        "whether the gaze keeps its direction in W while the body turns",
        type=BOOL,
    ),
    Column(
        f"{GAZE}.body_direction",
        "direction in W that the body turns to for a fixed camera",
        "rad",
        optional=True,
    ),
    Column(
        (f"{GAZE}.psi_lm", f"{GAZE}.psi_sf", f"{GAZE}.psi_ob", f"{GAZE}.psi_way"),
        "partial evaluations of local map, self, obstacle and way",
        "1",
        (4,),
        name="psi",
    ),
    Column(
        "gaze_map",
        "gaze map GM in 255 shades of its maximum, from below and from the right",
        "1",
        ("tilts", "pans"),
        SHADE,
        optional=True,
    ),
    Column(
        "local_map",
        "confidence in 255 shades, from minimum y and minimum x",
        "1",
        ("rows", "columns"),
        SHADE,
        optional=True,
    ),
    Column("map_hash", "hash of the whole local map, recorded with it", type=BYTES, optional=True),
    Column(
        f"{BELIEF}.local_map.origin",
        "corner of minimum x and y of the local map in W",
        "m",
        (2,),
        name="map_origin",
    ),
    Column(f"{BELIEF}.local_map.cell", "side of a cell of the local map", "m", name="map_cell"),
    Column("particles", "particles of lost movers", items=PARTICLE),
    Column(
        "field.points",
        "points in W at which the direction field is sampled",
        "m",
        (VARYING, 2),
        name="field_points",
    ),
    Column(
        "field.directions",
        "unit vectors at `field_points`",
        "1",
        (VARYING, 2),
        name="field_directions",
    ),
    Column("field.path", "path along the field in W", "m", (VARYING, 2), name="field_path"),
)
