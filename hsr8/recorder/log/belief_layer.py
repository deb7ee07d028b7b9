"""Belief: pose, tracks, particles, local map, virtual obstacles, target."""

from collections.abc import Sequence
from math import pi

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.frame_record import FrameRecord
from hsr8.recorder import ellipse, palette
from hsr8.recorder.log.block_stream import BlockStream
from hsr8.recorder.log.channel import Channel
from hsr8.recorder.throttle import Throttle
from navigation.belief.belief import Belief, Motion
from navigation.decision import MotionDecision
from navigation.observation import CameraView

Array = NDArray[np.float64]

SIGMAS = 2.0  # standard deviations of ellipses
# Lengths are those in a world of scale 1.
HEADING_LENGTH = 0.35  # [m]
VELOCITY_SCALE = 2.0  # prediction time of velocity arrows [s]
VIEW_RANGE = 1.5  # drawn length of the field of view [m]
MAP_HEIGHT, MARK_HEIGHT = 0.002, 0.012  # heights of flat drawings [m]
FLAT = 0.004  # their thickness [m]
PARTICLE, PARTICLE_WEIGHTS = 0.025, (0.2, 4.0)  # drawn radius [m], range of relative weights
MAX_SIGMA = 0.5  # of a drawn ellipse [m]
SEEN, UNSEEN = 255, 160  # opacity of tracks in view and out of it


class BeliefLayer:
    """Layer of the belief.

    Args:
        stream: recording.
        map_period: minimum interval between two local maps and particle clouds [s].
        scale: of the world [1].
    """

    def __init__(self, stream: BlockStream, map_period: float, scale: float = 1.0) -> None:
        self._scale = scale
        self._stream = stream
        self._map_throttle = Throttle(map_period)
        self._map_shape: tuple[int, ...] = ()
        self._motion: MotionDecision | None = None  # of the shown virtual obstacles
        self._target_position: list[float] = []
        solid = rr.components.FillMode.Solid
        lines = rr.components.FillMode.MajorWireframe
        blue, arrows, cylinders = [palette.BELIEF], rr.Arrows3D, rr.Cylinders3D
        rings = {"colors": blue, "fill_mode": lines, "line_radii": [0.004 * scale]}
        virtual = {"colors": [palette.VIRTUAL], "fill_mode": lines, "line_radii": [0.006 * scale]}

        def channel(name: str, archetype: type, **style: object) -> Channel:
            return Channel(stream, f"/belief/{name}", archetype, **style)

        self._pose = channel("pose", arrows, colors=blue, radii=[0.015 * scale])
        self._uncertainty = channel("uncertainty", rr.Ellipsoids3D, **rings)
        self._tracks = channel("tracks", cylinders, fill_mode=solid)
        self._track_uncertainty = channel("track_uncertainty", rr.Ellipsoids3D, **rings)
        self._velocities = channel("velocities", arrows, colors=blue, radii=[0.01 * scale])
        self._virtual = channel("virtual_obstacles", cylinders, **virtual)
        edge = {"colors": [palette.VIEW], "radii": [0.008 * scale]}
        self._view = channel("view", rr.LineStrips3D, **edge)
        ball = {"colors": [palette.TARGET], "radii": [0.05 * scale]}
        self._target = channel("target", rr.Points3D, **ball)
        self._particles = channel("particles", rr.Points3D)
        self._map = channel("local_map", rr.GridMap)

    def add(self, frames: Sequence[FrameRecord]) -> None:
        """Take camera frames."""
        times, beliefs = [frame.time for frame in frames], [frame.belief for frame in frames]
        poses = np.array([belief.pose for belief in beliefs])
        ones = [1] * len(times)
        centres, ahead = np.full((len(times), 3), MARK_HEIGHT), np.zeros((len(times), 3))
        centres[:, :2] = poses[:, :2]
        ahead[:, 0], ahead[:, 1] = np.cos(poses[:, 2]), np.sin(poses[:, 2])
        self._pose.add_rows(
            times, ones, origins=centres, vectors=HEADING_LENGTH * self._scale * ahead
        )
        covariances = np.array([belief.pose_covariance for belief in beliefs])[:, :2, :2]
        self._ellipses(self._uncertainty, times, ones, centres, covariances)
        self._view.add_rows(
            times, ones, strips=list(_wedges(poses, [b.view for b in beliefs], self._scale))
        )
        self._add_tracks(times, beliefs)
        for frame in frames:
            if frame.motion is not self._motion:
                self._motion = frame.motion
                self._add_virtual(frame)
            target = frame.task.target.tolist()
            if target != self._target_position:
                self._target_position = target
                self._target.add(frame.time, positions=np.array([[*target, 0.05 * self._scale]]))
            if self._map_throttle.due(frame.time):
                self._add_particles(frame.time, frame.belief)
                self._add_map(frame.time, frame.belief)

    def _add_tracks(self, times: list[float], beliefs: Sequence[Belief]) -> None:
        tracks = [track for belief in beliefs for track in belief.tracks]
        rows = np.repeat(np.arange(len(times)), [len(belief.tracks) for belief in beliefs])
        centres = np.full((len(tracks), 3), MARK_HEIGHT)
        centres[:, :2] = np.reshape([t.position for t in tracks], (-1, 2))
        colors = [
            palette.packed(palette.of_label(t.label), SEEN if t.visible else UNSEEN) for t in tracks
        ]
        self._tracks.add_rows(
            times,
            _counts(times, rows),
            centers=centres,
            lengths=np.full(len(tracks), FLAT),
            radii=np.array([t.radius for t in tracks]),
            colors=np.array(colors, dtype=np.uint32),
        )
        covariances = np.reshape([t.covariance for t in tracks], (-1, 4, 4))[:, :2, :2]
        known = np.trace(covariances, axis1=1, axis2=2) < (MAX_SIGMA * self._scale) ** 2
        counts = _counts(times, rows[known])
        self._ellipses(self._track_uncertainty, times, counts, centres[known], covariances[known])
        moving = np.array([t.motion is not Motion.STATIC for t in tracks], dtype=bool)
        vectors = np.zeros((len(tracks), 3))
        vectors[:, :2] = np.reshape([t.velocity for t in tracks], (-1, 2))
        self._velocities.add_rows(
            times,
            _counts(times, rows[moving]),
            origins=centres[moving],
            vectors=VELOCITY_SCALE * vectors[moving],
        )

    def _add_particles(self, time: float, belief: Belief) -> None:
        """Add the particles of lost movers, with radii by weight."""
        clouds = [(t, t.particles) for t in belief.tracks if t.particles is not None]
        positions = [cloud.positions for _, cloud in clouds]
        relative = [len(cloud.weights) * cloud.weights for _, cloud in clouds]
        points = np.concatenate(positions) if clouds else np.zeros((0, 2))
        weights = np.concatenate(relative) if clouds else np.zeros(0)
        colors = [
            palette.packed(palette.darker(palette.of_label(t.label)))
            for t, cloud in clouds
            for _ in range(len(cloud.weights))
        ]
        self._particles.add(
            time,
            positions=np.column_stack([points, np.full(len(points), MARK_HEIGHT)]),
            radii=PARTICLE * self._scale * np.sqrt(np.clip(weights, *PARTICLE_WEIGHTS)),
            colors=np.array(colors, dtype=np.uint32),
        )

    def _add_virtual(self, frame: FrameRecord) -> None:
        virtual = frame.motion.virtual_obstacles
        centres = np.full((len(virtual), 3), MARK_HEIGHT)
        centres[:, :2] = np.array([o.position for o in virtual]).reshape(-1, 2)
        self._virtual.add(
            frame.time,
            centers=centres,
            lengths=np.full(len(virtual), FLAT),
            radii=np.array([o.radius for o in virtual]),
        )

    def _add_map(self, time: float, belief: Belief) -> None:
        grid = belief.local_map
        # The first row of an image is its top, the first row of the map its minimum y.
        cells = np.round(255.0 * grid.confidence[::-1]).astype(np.uint8)
        if cells.shape != self._map_shape:
            self._map_shape = cells.shape
            self._stream.log("/belief/local_map", _map_style(grid.cell, cells.shape), static=True)
        self._map.add(
            time, data=[cells.ravel()], translation=np.array([[*grid.origin, MAP_HEIGHT]])
        )

    @staticmethod
    def _ellipses(
        channel: Channel,
        times: list[float],
        counts: list[int],
        centres: Array,
        covariances: Array,
    ) -> None:
        half, direction = ellipse.axes(covariances)
        n = len(half)
        quaternions = np.zeros((n, 4))
        quaternions[:, 2], quaternions[:, 3] = np.sin(direction / 2), np.cos(direction / 2)
        channel.add_rows(
            times,
            counts,
            centers=centres,
            half_sizes=np.column_stack([SIGMAS * half, np.full(n, FLAT)]),
            quaternions=quaternions,
        )


def _counts(times: list[float], rows: NDArray[np.intp]) -> list[int]:
    """Return the number of elements in `rows` for each of the times."""
    counts: list[int] = np.bincount(rows, minlength=len(times)).tolist()
    return counts


def _map_style(cell: float, shape: tuple[int, ...]) -> rr.GridMap:
    """Return the style of a map with `shape` rows and columns."""
    return rr.GridMap.from_fields(
        format=rr.components.ImageFormat(
            width=shape[1],
            height=shape[0],
            color_model=rr.ColorModel.L,
            channel_datatype=rr.ChannelDatatype.U8,
        ),
        cell_size=cell,
        opacity=0.35,
        colormap=rr.components.Colormap.Grayscale,
    )


def _wedges(poses: Array, views: Sequence[CameraView], scale: float = 1.0) -> Array:
    """Return the outlines of the fields of view on the floor (m, n, 3) [m]."""
    axes = np.array([view.rotation[:, 2] for view in views])
    middles = poses[:, 2] + np.arctan2(axes[:, 1], axes[:, 0])
    halves = np.minimum([0.5 * view.horizontal_fov for view in views], pi)
    angles = middles[:, None] + halves[:, None] * np.linspace(-1.0, 1.0, 9)
    outlines = np.full((len(poses), 11, 3), MARK_HEIGHT)
    outlines[:, :, :2] = poses[:, None, :2]
    outlines[:, 1:-1, 0] += VIEW_RANGE * scale * np.cos(angles)
    outlines[:, 1:-1, 1] += VIEW_RANGE * scale * np.sin(angles)
    return outlines
