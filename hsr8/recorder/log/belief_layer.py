"""Belief: pose, tracks, particles, local map, virtual obstacles, target."""

from math import pi

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recorder import ellipse, palette
from hsr8.recorder.log.channel import BlockStream, Channel
from hsr8.recorder.log.geometry import raised
from hsr8.recorder.table import Items, Table
from navigation.belief.belief import Motion

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
MAP_OPACITY = 0.7  # opacity of ground in view [1]


class BeliefLayer:
    """Layer of the belief.

    Args:
        stream: recording.
        scale: of the world [1].
    """

    def __init__(self, stream: BlockStream, scale: float = 1.0) -> None:
        self._scale = scale
        self._stream = stream
        self._map_shape: tuple[int, ...] = ()
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

    def add(self, frames: Table, shown: Table) -> None:
        """Take camera frames.

        Args:
            frames: all new frames.
            shown: those at the rate of the log.
        """
        times, poses = shown["time"].tolist(), shown["pose"]
        ones = [1] * len(times)
        centres = raised(poses[:, :2], MARK_HEIGHT)
        ahead = np.column_stack([np.cos(poses[:, 2]), np.sin(poses[:, 2]), np.zeros(len(poses))])
        self._pose.add_rows(
            times, ones, origins=centres, vectors=HEADING_LENGTH * self._scale * ahead
        )
        covariances = shown["pose_covariance"][:, :2, :2]
        self._ellipses(self._uncertainty, times, ones, centres, covariances)
        self._view.add_rows(times, ones, strips=_wedges(shown, self._scale))
        self._add_tracks(times, shown["tracks"])
        self._add_virtual(frames.take(np.flatnonzero(frames["planned"])))
        for time, target in zip(frames["time"].tolist(), frames["target"].tolist(), strict=True):
            if target != self._target_position:
                self._target_position = target
                self._target.add(time, positions=np.array([[*target, 0.05 * self._scale]]))
        rows, maps = frames.present("local_map")
        with_map = frames.take(rows)
        self._add_particles(with_map)
        self._add_maps(with_map, maps)

    def _add_tracks(self, times: list[float], tracks: Items) -> None:
        n, rows = len(times), tracks.parents
        centres = raised(tracks["position"], MARK_HEIGHT)
        colors = [
            palette.packed(palette.of_label(label), SEEN if visible else UNSEEN)
            for label, visible in zip(tracks["label"], tracks["visible"], strict=True)
        ]
        self._tracks.add_rows(
            times,
            tracks.counts.tolist(),
            centers=centres,
            lengths=np.full(len(tracks), FLAT),
            radii=tracks["radius"],
            colors=np.array(colors, dtype=np.uint32),
        )
        covariances = tracks["covariance"][:, :2, :2]
        known = np.trace(covariances, axis1=1, axis2=2) < (MAX_SIGMA * self._scale) ** 2
        counts = _counts(n, rows[known])
        self._ellipses(self._track_uncertainty, times, counts, centres[known], covariances[known])
        moving = tracks["motion"] != Motion.STATIC
        vectors = np.column_stack([tracks["velocity"], np.zeros(len(tracks))])
        self._velocities.add_rows(
            times,
            _counts(n, rows[moving]),
            origins=centres[moving],
            vectors=VELOCITY_SCALE * vectors[moving],
        )

    def _add_particles(self, frames: Table) -> None:
        """Add the particles of lost movers, with radii by weight."""
        particles = frames["particles"]
        colors = [
            palette.packed(palette.darker(palette.of_label(label))) for label in particles["label"]
        ]
        radii = PARTICLE * self._scale * np.sqrt(np.clip(particles["weight"], *PARTICLE_WEIGHTS))
        self._particles.add_rows(
            frames["time"].tolist(),
            particles.counts.tolist(),
            positions=raised(particles["position"], MARK_HEIGHT),
            radii=radii,
            colors=np.array(colors, dtype=np.uint32),
        )

    def _add_virtual(self, frames: Table) -> None:
        virtual = frames["virtual_obstacles"]
        self._virtual.add_rows(
            frames["time"].tolist(),
            virtual.counts.tolist(),
            centers=raised(virtual["position"], MARK_HEIGHT),
            lengths=np.full(len(virtual), FLAT),
            radii=virtual["radius"],
        )

    def _add_maps(self, frames: Table, maps: NDArray[np.uint8]) -> None:
        """Add local maps (n, rows, columns)."""
        if not len(frames):
            return
        if maps.shape[1:] != self._map_shape:
            self._map_shape = maps.shape[1:]
            style = _map_style(float(frames["map_cell"][0]), self._map_shape)
            self._stream.log("/belief/local_map", style, static=True)
        origins = frames["map_origin"].tolist()
        for time, cells, origin in zip(frames["time"].tolist(), maps, origins, strict=True):
            # The first row of an image is its top, the first row of the map its minimum y.
            self._map.add(
                time,
                data=[_seen_ground(cells[::-1])],
                translation=np.array([[*origin, MAP_HEIGHT]]),
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


def _counts(n: int, rows: NDArray[np.intp]) -> list[int]:
    """Return the number of elements in `rows` for each of `n` rows."""
    counts: list[int] = np.bincount(rows, minlength=n).tolist()
    return counts


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


def _wedges(frames: Table, scale: float = 1.0) -> Array:
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
