"""Fingerprints of beliefs and decisions: equal bits have equal fingerprints."""

import hashlib
import struct
from math import nan

from hsr8.decisions import Decision
from navigation.belief.belief import Belief

CHANNELS = ("pose", "pose covariance", "tracks", "local map", "state")
DECISIONS = ("belief at the decision", "task", "motion", "gaze")
FINGERPRINT = 8  # bytes per channel


def fingerprints(belief: Belief) -> tuple[bytes, ...]:
    """Return the digest of each channel of a belief, in the order of `CHANNELS`."""
    tracks: list[bytes] = []
    for t in belief.tracks:
        text = f"{t.id} {t.label} {t.motion} {t.hits} {t.visible}"
        numbers = (t.radius, t.radius_sigma, t.age, t.reach, t.turn_rate)
        tracks += (text.encode(), struct.pack("<5d", *numbers))
        parts = [t.position, t.velocity, t.covariance, t.last_seen]
        if t.particles is not None:
            cloud = t.particles
            parts += (cloud.positions, cloud.velocities, cloud.turn_rates, cloud.weights)
        tracks += [part.tobytes() for part in parts]
    state = f"{belief.seen_beacons} {belief.lost} {belief.filter_faults}"
    return (
        _digest(belief.pose.tobytes()),
        _digest(belief.pose_covariance.tobytes()),
        _digest(b"".join(tracks)),
        _digest(*(part.data for part in belief.local_map.contents())),
        _digest(state.encode()),
    )


def decision_fingerprints(
    decision: Decision, believed: tuple[bytes, ...] | None = None
) -> tuple[bytes, ...]:
    """Return the digest of each part of a decision, in the order of `DECISIONS`.

    Args:
        decision: to hash.
        believed: fingerprints of its belief, if known.
    """
    task, motion, gaze = decision.task, decision.motion, decision.gaze
    target = f"{task.is_goal} {task.index} {task.aligning} {task.done}".encode()
    target += task.target.tobytes() + struct.pack("<d", task.heading)
    move = motion.situation.encode() + motion.velocity.tobytes()
    look_request = nan if motion.look_request is None else motion.look_request
    move += struct.pack("<3d", motion.direction, motion.speed, look_request)
    for v in motion.virtual_obstacles:
        move += v.position.tobytes() + struct.pack("<dq", v.radius, v.track_id)
    for track, radius in motion.extended_radii:
        move += struct.pack("<qd", track, radius)
    evaluations = (gaze.psi_lm, gaze.psi_sf, gaze.psi_ob, gaze.psi_way)
    look = struct.pack("<6d", gaze.pan, gaze.tilt, *evaluations) + gaze.gaze_map.tobytes()
    believed = believed or fingerprints(decision.belief)
    return _digest(b"".join(believed)), _digest(target), _digest(move), _digest(look)


def _digest(*parts: bytes | memoryview) -> bytes:
    digest = hashlib.blake2b(digest_size=FINGERPRINT)
    for part in parts:
        digest.update(part)
    return digest.digest()
