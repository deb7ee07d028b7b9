"""Candidates of obstacles and beacons from the edges of blobs.

An obstacle is one blob, a beacon a blob of one beacon colour stacked on another.
"""

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.tables import (
    ANY,
    FAR,
    FOOT,
    HEAD,
    LEFT,
    NEAR,
    RIGHT,
    Candidate,
    Points,
    add_rim,
    copy_side,
    count_next_to,
    mean_height,
    set_obstacle,
)

Bools = NDArray[np.bool_]
Rows = NDArray[np.record]

MIN_SPAN = 1e-3  # added to the span of a side for its weight [1]


@compiled
def candidates_of(
    blobs: Rows, points: Points, beacon: Bools, camera_height: float, p: np.record
) -> Rows:
    """Return the candidates of an image, obstacles first, records of type `Candidate`.

    Args:
        blobs: records of type `Blob`.
        points: points of their rims.
        beacon: whether each colour class is one of beacons, by label.
        camera_height: above the floor [m].
        p: parameters.
    """
    count = 0
    for i in range(len(blobs)):
        count += not beacon[blobs[i].label]
        for j in range(len(blobs)):
            count += i != j and _stacked(blobs[i], blobs[j], beacon)
    candidates = np.zeros(count, Candidate)
    count = 0
    for k in range(len(blobs)):
        if not beacon[blobs[k].label]:
            candidates[count].upper = candidates[count].lower = k
            count += _set_obstacle(candidates[count], blobs[k], points, camera_height, p)
    for i in range(len(blobs)):
        for j in range(len(blobs)):
            if i != j and _stacked(blobs[i], blobs[j], beacon):
                candidates[count].upper, candidates[count].lower = i, j
                count += _set_beacon(
                    candidates[count], blobs[i], blobs[j], points, camera_height, p
                )
    return candidates[:count]


@compiled
def _stacked(upper: np.record, lower: np.record, beacon: Bools) -> bool:
    """Return whether two blobs are of beacon colours and their boxes touch or overlap."""
    if not (beacon[upper.label] and beacon[lower.label]):
        return False
    a, b = upper.box, lower.box
    return bool(a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3])


@compiled
def _set_obstacle(
    candidate: np.record, blob: np.record, points: Points, camera_height: float, p: np.record
) -> bool:
    """Set the candidate of a blob of an obstacle colour; return whether it has a usable edge."""
    set_obstacle(candidate, p)
    add_rim(candidate, blob.rims[FOOT], 0, points, 0.0, NEAR)
    if camera_height > p.obstacle_height:
        add_rim(candidate, blob.rims[HEAD], ANY, points, mean_height(candidate), FAR)
    for j in range(2):
        copy_side(candidate.sides[j], blob.sides[j])
    _set_occluded(candidate, blob, points, p)
    trusted = blob.sides[LEFT].trusted or blob.sides[RIGHT].trusted
    return bool(candidate.rim_count > 0 or trusted)


@compiled
def _set_beacon(
    candidate: np.record,
    upper: np.record,
    lower: np.record,
    points: Points,
    camera_height: float,
    p: np.record,
) -> bool:
    """Set the candidate of two stacked blobs; return whether they look like one beacon."""
    seam = upper.rims[FOOT]
    width = count_next_to(seam, int(lower.label), points)
    if width == 0 or width < p.min_beacon_seam_fraction * (seam.last - seam.first):
        return False
    sides = candidate.sides
    for j in range(2):
        if not _merge(sides[j], upper.sides[j], lower.sides[j], p.beacon_side_tolerance):
            return False
    if not (sides[LEFT].trusted or sides[RIGHT].trusted):
        return False
    middle, height = 0.5 * p.beacon_height, float(p.beacon_height / p.unit)
    candidate.height, candidate.height_sigma = height, 0.0
    candidate.prior[0] = p.beacon_radius / p.unit
    candidate.prior[1] = p.known_radius_sigma / p.unit
    candidate.rim_count = 0
    add_rim(candidate, lower.rims[FOOT], 0, points, 0.0, NEAR)
    half = NEAR if camera_height > middle else FAR
    add_rim(candidate, seam, int(lower.label), points, middle / p.unit, half)
    half = NEAR if camera_height < p.beacon_height else FAR
    add_rim(candidate, upper.rims[HEAD], ANY, points, height, half)
    _set_occluded(candidate, lower, points, p)
    return True


@compiled
def _merge(side: np.record, a: np.record, b: np.record, tolerance: float) -> bool:
    """Set the common side of two colours; return whether they agree.

    Args:
        side: output.
        a: side of one colour.
        b: side of the other colour.
        tolerance: maximum difference [standard deviations].
    """
    both = a.trusted and b.trusted
    if both and abs(a.azimuth - b.azimuth) > tolerance * (a.sigma + b.sigma) / 2.0:
        return False
    copy_side(side, a if a.trusted else b)
    side.occluded = a.occluded or b.occluded
    if both:
        # Weights: the longer part averages more pixels.
        wa, wb = a.high - a.low + MIN_SPAN, b.high - b.low + MIN_SPAN
        side.azimuth = (wa * a.azimuth + wb * b.azimuth) / (wa + wb)
        side.sigma, side.points = max(a.sigma, b.sigma), a.points + b.points
        side.low, side.high = min(a.low, b.low), max(a.high, b.high)
    return True


@compiled
def _set_occluded(candidate: np.record, blob: np.record, points: Points, p: np.record) -> None:
    """Set whether the sides of a candidate or the lower rim of its lower blob are occluded."""
    rim = blob.rims[FOOT]
    length = rim.last - rim.first
    covered = (length - count_next_to(rim, 0, points)) / max(length, 1)
    candidate.occluded = (
        covered > p.max_occlusion_fraction
        or candidate.sides[LEFT].occluded
        or candidate.sides[RIGHT].occluded
    )
