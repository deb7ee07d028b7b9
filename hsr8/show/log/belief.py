"""Belief and plan: pose, tracks, particles, local map, virtual obstacles, target, field."""

from math import pi

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recording import palette
from hsr8.recording.derived import ellipse_axes
from hsr8.recording.table import Items, Table
from hsr8.show.log.shapes import raised
from hsr8.show.log.stream import LogStream
from navigation.belief.belief import Motion

Array = NDArray[np.float64]

SIGMAS = 2.0  # standard deviations of ellipses
# Lengths are those in a world of scale 1.
HEADING_LENGTH = 0.35  # [m]
VELOCITY_SCALE = 2.0  # prediction time of velocity arrows [s]
VIEW_RANGE = 1.5  # drawn length of the field of view [m]
MAP_HEIGHT, MARK_HEIGHT, PLAN_HEIGHT = 0.002, 0.012, 0.016  # heights of flat drawings [m]
FLAT = 0.004  # thickness of flat drawings [m]
FIELD_ARROW = 0.13  # length of the arrows of the direction field [m]
PARTICLE, PARTICLE_WEIGHTS = 0.025, (0.2, 4.0)  # drawn radius [m], range of relative weights
MAX_SIGMA = 0.5  # standard deviation above which no ellipse is drawn [m]
SEEN, UNSEEN = 255, 160  # opacity of tracks in view and out of it
MAP_OPACITY = 0.7  # opacity of ground in view [1]


def style_belief(log: LogStream, scale: float) -> None:
    """Set the styles of belief and plan in a world of a `scale` [1]."""
    solid, lines = rr.components.FillMode.Solid, rr.components.FillMode.MajorWireframe
    blue, plan = [palette.BELIEF], [palette.PLAN]
    for name, archetype, style in (
        ("belief/pose", rr.Arrows3D, {"colors": blue, "radii": [0.015 * scale]}),
        ("belief/tracks", rr.Cylinders3D, {"fill_mode": solid}),
        ("belief/velocities", rr.Arrows3D, {"colors": blue, "radii": [0.01 * scale]}),
        (
            "belief/virtual_obstacles",
            rr.Cylinders3D,
            {"colors": [palette.VIRTUAL], "fill_mode": lines, "line_radii": [0.006 * scale]},
        ),
        ("belief/view", rr.LineStrips3D, {"colors": [palette.VIEW], "radii": [0.008 * scale]}),
        ("belief/target", rr.Points3D, {"colors": [palette.TARGET], "radii": [0.05 * scale]}),
        ("plan/field", rr.Arrows3D, {"colors": [palette.FIELD], "radii": [0.008 * scale]}),
        ("plan/path", rr.LineStrips3D, {"colors": plan, "radii": [0.007 * scale]}),
        ("plan/decision", rr.Arrows3D, {"colors": plan, "radii": [0.011 * scale]}),
    ):
        log.style(f"/{name}", archetype, **style)
    for name in ("uncertainty", "track_uncertainty"):
        ring = {"colors": blue, "fill_mode": lines, "line_radii": [0.004 * scale]}
        log.style(f"/belief/{name}", rr.Ellipsoids3D, **ring)


def log_belief(log: LogStream, frames: Table, shown: Table, scale: float) -> None:
    """Log the belief and the plan.

    Args:
        log: recording.
        frames: all new camera frames.
        shown: camera frames at the rate of the log.
        scale: scale of the world [1].
    """
    times, poses = shown["time"], shown["pose"]
    centres = raised(poses[:, :2], MARK_HEIGHT)
    ahead = np.column_stack([np.cos(poses[:, 2]), np.sin(poses[:, 2]), np.zeros(len(poses))])
    vectors = HEADING_LENGTH * scale * ahead
    log.rows("/belief/pose", rr.Arrows3D, times, origins=centres, vectors=vectors)
    ellipses = _ellipses(centres, shown["pose_covariance"][:, :2, :2])
    log.rows("/belief/uncertainty", rr.Ellipsoids3D, times, None, **ellipses)
    log.rows("/belief/view", rr.LineStrips3D, times, strips=_wedges(shown, scale))
    _log_tracks(log, times, shown["tracks"], scale)
    targets = frames["target"]
    rows = log.changed("/belief/target", targets.tolist())
    log.rows(
        "/belief/target",
        rr.Points3D,
        frames["time"][rows],
        positions=raised(targets[rows], 0.05 * scale),
    )
    _log_plan(log, frames.take(np.flatnonzero(frames["planned"])), scale)
    rows, maps = frames.present("local_map")
    with_map = frames.take(rows)
    _log_particles(log, with_map, scale)
    _log_maps(log, with_map, maps)


def _log_tracks(log: LogStream, times: Array, tracks: Items, scale: float) -> None:
    n, rows = len(times), tracks.parents
    centres = raised(tracks["position"], MARK_HEIGHT)
    colors = [
        palette.packed(palette.of_label(label), SEEN if visible else UNSEEN)
        for label, visible in zip(tracks["label"], tracks["visible"], strict=True)
    ]
    log.rows(
        "/belief/tracks",
        rr.Cylinders3D,
        times,
        tracks.counts,
        centers=centres,
        lengths=np.full(len(tracks), FLAT),
        radii=tracks["radius"],
        colors=np.array(colors, dtype=np.uint32),
    )
    covariances = tracks["covariance"][:, :2, :2]
    known = np.trace(covariances, axis1=1, axis2=2) < (MAX_SIGMA * scale) ** 2
    counts = np.bincount(rows[known], minlength=n)
    ellipses = _ellipses(centres[known], covariances[known])
    log.rows("/belief/track_uncertainty", rr.Ellipsoids3D, times, counts, **ellipses)
    moving = tracks["motion"] != Motion.STATIC
    vectors = np.column_stack([tracks["velocity"], np.zeros(len(tracks))])
    log.rows(
        "/belief/velocities",
        rr.Arrows3D,
        times,
        np.bincount(rows[moving], minlength=n),
        origins=centres[moving],
        vectors=VELOCITY_SCALE * vectors[moving],
    )


def _log_particles(log: LogStream, frames: Table, scale: float) -> None:
    """Log the particles of lost movers, with radii by weight."""
    particles = frames["particles"]
    colors = [
        palette.packed(palette.darker(palette.of_label(label))) for label in particles["label"]
    ]
    log.rows(
        "/belief/particles",
        rr.Points3D,
        frames["time"],
        particles.counts,
        positions=raised(particles["position"], MARK_HEIGHT),
        radii=PARTICLE * scale * np.sqrt(np.clip(particles["weight"], *PARTICLE_WEIGHTS)),
        colors=np.array(colors, dtype=np.uint32),
    )


def _log_plan(log: LogStream, planned: Table, scale: float) -> None:
    """Log new motion decisions, with the field of planners that have one."""
    times, virtual = planned["time"], planned["virtual_obstacles"]
    log.rows(
        "/belief/virtual_obstacles",
        rr.Cylinders3D,
        times,
        virtual.counts,
        centers=raised(virtual["position"], MARK_HEIGHT),
        lengths=np.full(len(virtual), FLAT),
        radii=virtual["radius"],
    )
    direction, length = planned["direction"], VELOCITY_SCALE * planned["speed"]
    arrows = np.column_stack([length * np.cos(direction), length * np.sin(direction)])
    origins = raised(planned["pose"][:, :2], PLAN_HEIGHT)
    vectors = raised(arrows, 0.0)
    log.rows("/plan/decision", rr.Arrows3D, times, origins=origins, vectors=vectors)
    counts = np.array([len(points) for points in planned["field_points"]], np.intp)
    rows = np.flatnonzero(counts)
    if not len(rows):
        return
    field = planned.take(rows)
    points = raised(np.concatenate(field["field_points"]), PLAN_HEIGHT)
    vectors = FIELD_ARROW * scale * raised(np.concatenate(field["field_directions"]), 0.0)
    origins = points - 0.5 * vectors  # arrows are centred on their points
    log.rows(
        "/plan/field", rr.Arrows3D, times[rows], counts[rows], origins=origins, vectors=vectors
    )
    paths = [raised(path, PLAN_HEIGHT) for path in field["field_path"]]
    log.rows("/plan/path", rr.LineStrips3D, times[rows], strips=paths)


def _log_maps(log: LogStream, frames: Table, maps: NDArray[np.uint8]) -> None:
    """Log local maps (n, rows, columns)."""
    if not len(frames):
        return
    path, shape = "/belief/local_map", maps.shape[1:]
    if len(log.changed(path, [shape])):
        log.log(path, _map_style(float(frames["map_cell"][0]), shape), static=True)
    log.rows(
        path,
        rr.GridMap,
        frames["time"],
        # The first row of an image is its top, the first row of the map its minimum y.
        data=[_seen_ground(cells[::-1]) for cells in maps],
        translation=raised(frames["map_origin"], MAP_HEIGHT),
    )


def _map_style(cell: float, shape: tuple[int, ...]) -> rr.GridMap:
    """Return the style of a map with `shape` rows and columns."""
    return rr.GridMap.from_fields(
        format=rr.components.ImageFormat(
            width=shape[1],
            height=shape[0],
            color_model=rr.ColorModel.RGBA,
            channel_datatype=rr.ChannelDatatype.U8,
        ),
        cell_size=cell,
        opacity=0.99,  # below one, so that the viewer blends the pixels
    )


def _seen_ground(cells: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return the pixels of a map (4 n,): white, as opaque as the ground is confident."""
    pixels = np.empty((cells.size, 4), np.uint8)
    pixels[:, :3] = 255
    pixels[:, 3] = MAP_OPACITY * cells.ravel()
    return pixels.ravel()


def _ellipses(centres: Array, covariances: Array) -> dict[str, Array]:
    """Return Rerun's components of the ellipses of covariances (n, 2, 2) [m²]."""
    half, direction = ellipse_axes(covariances)
    quaternions = np.zeros((len(half), 4))
    quaternions[:, 2], quaternions[:, 3] = np.sin(direction / 2), np.cos(direction / 2)
    half_sizes = np.column_stack([SIGMAS * half, np.full(len(half), FLAT)])
    return {"centers": centres, "half_sizes": half_sizes, "quaternions": quaternions}


def _wedges(frames: Table, scale: float) -> Array:
    """Return the outlines of the fields of view on the floor (m, n, 3) [m]."""
    poses, axes = frames["pose"], frames["camera_rotation"][:, :, 2]
    middles = poses[:, 2] + np.arctan2(axes[:, 1], axes[:, 0])
    halves = np.minimum(0.5 * frames["fov"][:, 0], pi)
    angles = middles[:, None] + halves[:, None] * np.linspace(-1.0, 1.0, 9)
    outlines = np.full((len(poses), 11, 3), MARK_HEIGHT)
    outlines[:, :, :2] = poses[:, None, :2]
    outlines[:, 1:-1, 0] += VIEW_RANGE * scale * np.cos(angles)
    outlines[:, 1:-1, 1] += VIEW_RANGE * scale * np.sin(angles)
    return outlines
