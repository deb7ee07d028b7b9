"""Recorded objects: camera frames with what is recorded only when it is new, and images."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from hsr8.simulation.decisions import FrameRecord, Image
from hsr8.simulation.record import Tick
from navigation.belief.belief import Belief
from navigation.belief.tracks import Tracks
from navigation.decision import DirectionField, GazeDecision, MotionDecision
from navigation.motion.univector import normalized

Array = NDArray[np.float64]

MAP_PERIOD = 1.0  # between two local maps, particle clouds or fields [s]
HASH = 16  # bytes of the hash of a local map
# Lengths are those in a world of scale 1.
SPACING, REACH = 0.25, 1.5  # of the points, and their maximum distance [m]
STEP, STEPS = 0.15, 8  # of the path that follows the field [m]


class Throttle:
    """Selection of samples by time.

    Args:
        period: minimum interval between two samples [s].
    """

    __slots__ = ("_last", "_period")

    def __init__(self, period: float) -> None:
        self._period = period
        self._last = -inf

    def select(self, times: NDArray[np.float64]) -> NDArray[np.intp]:
        """Return the indices of the samples at `times` (n,) [s] that pass."""
        due = [k for k, time in enumerate(times.tolist()) if self.due(time)]
        return np.array(due, dtype=np.intp)

    def due(self, time: float) -> bool:
        """Return whether the sample at `time` [s] passes."""
        if time - self._last < self._period - 1e-9:
            return False
        self._last = time
        return True


@dataclass(frozen=True, slots=True)
class SampledField:
    """Samples of a direction field.

    Attributes:
        points: sampled points in W (n, 2) [m].
        directions: unit vectors at the points, zero where the field is (n, 2).
        path: path along the field from the robot (m, 2) [m].
    """

    points: Array = field(default_factory=lambda: np.zeros((0, 2)))
    directions: Array = field(default_factory=lambda: np.zeros((0, 2)))
    path: Array = field(default_factory=lambda: np.zeros((0, 2)))


NO_FIELD = SampledField()


@value
class RecordedParticle:
    """Particle of a lost mover.

    Attributes:
        label: colour class of its track.
        position: position in W (2,) [m].
        weight: weight relative to the mean weight of the track [1].
    """

    label: str
    position: Array
    weight: float


@value
class RecordedFrame:
    """Camera frame, the source of a row of ``frames``.

    Attributes:
        frame: detections, belief and decisions.
        tracks: believed obstacles as one structured array.
        planned: whether the motion is new.
        gaze_map, local_map: maps in shades; None if it is not recorded in this frame.
        map_hash: hash of the whole local map.
        particles: particles of lost movers.
        field: samples of the direction field.
    """

    frame: FrameRecord
    tracks: Tracks
    planned: bool
    gaze_map: NDArray[np.uint8] | None
    local_map: NDArray[np.uint8] | None
    map_hash: bytes | None
    particles: tuple[RecordedParticle, ...]
    field: SampledField


@value
class RecordedImage:
    """Image of the head camera, the source of a row of ``images``.

    Attributes:
        index: number of its frame.
        time: time at which the frame reached the robot [s].
        captured: time at which the image was taken [s].
        jpeg: the image.
    """

    index: int
    time: float
    captured: float
    jpeg: bytes


class FrameSampler:
    """Selection of the parts of camera frames that change rarely or are large.

    Args:
        scale: scale of the world [1].
    """

    def __init__(self, scale: float = 1.0) -> None:
        self._scale = scale
        self._gaze_map: Array | None = None
        self._motion: MotionDecision | None = None
        self._maps, self._fields = Throttle(MAP_PERIOD), Throttle(MAP_PERIOD)

    def sample(self, frame: FrameRecord) -> RecordedFrame:
        """Return the recorded parts of a camera frame."""
        belief, motion = frame.belief, frame.motion
        planned, self._motion = motion is not self._motion, motion
        maps = self._maps.due(frame.time)
        return RecordedFrame(
            frame=frame,
            tracks=Tracks.of(belief.tracks),
            planned=planned,
            gaze_map=self._shades(frame.gaze),
            local_map=confidence_shades(belief) if maps else None,
            map_hash=_map_hash(belief) if maps else None,
            particles=_particles(Tracks.of(belief.tracks)) if maps else (),
            field=self._field(frame) if planned else NO_FIELD,
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


def objects_of(ticks: Sequence[Tick], sampler: FrameSampler) -> dict[str, Sequence[Any]]:
    """Return the recorded objects of each table but the images, in the order of writing.

    The seconds are last: readers of a run in progress wait for them.
    """
    records = [tick.record for tick in ticks if tick.record is not None]
    return {
        "ticks": ticks,
        "records": records,
        "frames": [sampler.sample(record.frame) for record in records if record.frame is not None],
        "events": [event for tick in ticks for event in tick.events],
        "commands": [command for tick in ticks for command in tick.commands],
        "seconds": [second for tick in ticks for second in tick.seconds],
    }


def image_row(frame: FrameRecord, quality: int) -> RecordedImage:
    """Return the row of the image of a frame, compressed with a `quality` [%]."""
    assert frame.image is not None
    jpeg = jpeg_of(frame.image, quality)
    return RecordedImage(frame.index, frame.time, frame.measured.time, jpeg)


def jpeg_of(image: Image, quality: int) -> bytes:
    """Return an image (height, width, 3), compressed with a `quality` [%]."""
    bgr = cv2.cvtColor(image, cv2.COLOR_RGB2BGR)
    return cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes()


def confidence_shades(belief: Belief) -> NDArray[np.uint8]:
    """Return the confidence of the local map in 255 shades."""
    return np.round(255.0 * belief.local_map.confidence).astype(np.uint8)


def _map_hash(belief: Belief) -> bytes:
    state = hashlib.blake2b(digest_size=HASH)
    for part in belief.local_map.contents():
        state.update(part.data)
    return state.digest()


def _particles(tracks: Tracks) -> tuple[RecordedParticle, ...]:
    return tuple(
        RecordedParticle(track.label, position, len(cloud.weights) * weight)
        for track in tracks.where(tracks.lost)
        if (cloud := track.particles) is not None
        for position, weight in zip(cloud.positions, cloud.weights.tolist(), strict=True)
    )


def sampled(
    directions: DirectionField, position: Array, target: Array, scale: float
) -> SampledField:
    """Sample a field.

    Args:
        directions: the field.
        position: position of the robot in W (2,) [m].
        target: destination in W (2,) [m].
        scale: scale of the world [1].
    """
    points = grid(position, scale)
    path = path_along(directions, position, target, scale)
    return SampledField(points, normalized(directions.at(points)), path)


def grid(position: Array, scale: float = 1.0) -> Array:
    """Return the points of a fixed grid around `position` (2,) (n, 2) [m]."""
    spacing, reach = SPACING * scale, REACH * scale
    centre = np.round(position / spacing) * spacing
    steps = np.arange(-reach, reach + 0.5 * spacing, spacing)
    x, y = np.meshgrid(centre[0] + steps, centre[1] + steps)
    points = np.column_stack([x.ravel(), y.ravel()])
    inside: Array = points[np.hypot(*(points - position).T) <= reach]
    return inside


def path_along(field: DirectionField, position: Array, target: Array, scale: float = 1.0) -> Array:
    """Return the path along a field from `position` (2,) up to `target` (2,) (n, 2) [m]."""
    path, step = [np.asarray(position, dtype=float)], STEP * scale
    for _ in range(STEPS):
        if float(np.hypot(*(target - path[-1]))) <= step:
            path.append(target)
            break
        path.append(path[-1] + step * normalized(field.at(path[-1])))
    return np.array(path)
