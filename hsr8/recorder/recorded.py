"""Recorded objects: camera frames with what is recorded only when it is new, and images."""

import hashlib
from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.frame_record import FrameRecord
from hsr8.record import Tick
from hsr8.recorder.sampled_field import NO_FIELD, SampledField, sampled
from hsr8.recorder.throttle import Throttle
from navigation.belief.belief import Belief
from navigation.belief.tracks import Tracks
from navigation.decision import GazeDecision, MotionDecision
from walking.signals import value

Array = NDArray[np.float64]

MAP_PERIOD = 1.0  # between two local maps, particle clouds or fields [s]
HASH = 16  # bytes of the hash of a local map


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
        "seconds": [second for tick in ticks for second in tick.seconds],
    }


def image_row(frame: FrameRecord, quality: int) -> RecordedImage:
    """Return the row of the image of a frame, compressed with a `quality` [%]."""
    assert frame.image is not None
    bgr = cv2.cvtColor(frame.image, cv2.COLOR_RGB2BGR)
    jpeg = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes()
    return RecordedImage(frame.index, frame.time, frame.measured.time, jpeg)


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
