"""Beacon hypotheses: a blob of one beacon colour stacked on another."""

from collections.abc import Sequence
from dataclasses import replace

from compilation.value import value
from vision.blob import Blob
from vision.cylinder import Candidate, RimCue
from vision.outline import Outline, Rim, Side
from vision.parameters import VisionParameters


@value
class Post:
    """Beacon hypothesis from two blobs.

    Attributes:
        upper, lower: indices of the blobs.
        candidate: edges.
    """

    upper: int
    lower: int
    candidate: Candidate


def find_posts(
    blobs: Sequence[Blob],
    outlines: Sequence[Outline],
    indices: Sequence[int],
    camera_height: float,
    parameters: VisionParameters,
) -> list[Post]:
    """Return the pairs of blobs stacked like the two colours of a beacon.

    Args:
        blobs: blobs of one image.
        outlines: outlines of the blobs.
        indices: the blobs of beacon colours.
        camera_height: above the floor [m].
        parameters: sizes of beacons.
    """
    posts = []
    for i in indices:
        bottom = outlines[i].bottom
        for j in indices:
            if i == j or not _adjacent(blobs[i], blobs[j]):
                continue
            seam = bottom.against(blobs[j].label)
            if (
                not seam.slope.size
                or seam.slope.size < parameters.min_beacon_seam_fraction * bottom.slope.size
            ):
                continue
            sides = _common_sides(outlines[i], outlines[j], parameters.beacon_side_tolerance)
            if sides is None:
                continue
            rims = _rims(seam, outlines[i].top, outlines[j].bottom, camera_height, parameters)
            candidate = Candidate(
                *sides,
                rims,
                parameters.beacon_height,
                parameters.beacon_radius,
                parameters.beacon_radius_sigma,
            )
            posts.append(Post(i, j, candidate))
    return posts


def _adjacent(upper: Blob, lower: Blob) -> bool:
    """Return whether the bounding boxes of two blobs touch or overlap."""
    a, b = upper.box, lower.box
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]


def _common_sides(upper: Outline, lower: Outline, tolerance: float) -> tuple[Side, Side] | None:
    """Return the left and right side of the whole post, None if the two colours disagree.

    Args:
        upper: outline of the upper colour.
        lower: outline of the lower colour.
        tolerance: maximum difference of their sides [standard deviations].
    """
    left = _merge(upper.left, lower.left, tolerance)
    right = _merge(upper.right, lower.right, tolerance)
    if left is None or right is None or not (left.trusted or right.trusted):
        return None
    return left, right


def _merge(a: Side, b: Side, tolerance: float) -> Side | None:
    """Return the common side, None if the sides differ by more [standard deviations]."""
    occluded = a.occluded or b.occluded
    low, high = min(a.low, b.low), max(a.high, b.high)
    if not (a.trusted and b.trusted):
        best = a if a.trusted else b
        return replace(best, occluded=occluded)
    if abs(a.azimuth - b.azimuth) > tolerance * (a.sigma + b.sigma) / 2.0:
        return None
    # Weights: the longer part averages more pixels.
    wa, wb = a.high - a.low + 1e-3, b.high - b.low + 1e-3
    azimuth = (wa * a.azimuth + wb * b.azimuth) / (wa + wb)
    return Side(azimuth, max(a.sigma, b.sigma), a.count + b.count, low, high, True, occluded)


def _rims(
    seam: Rim, top: Rim, bottom: Rim, camera_height: float, parameters: VisionParameters
) -> tuple[RimCue, ...]:
    """Return seam, foot and head of the post, as far as they have points."""
    head = parameters.beacon_height
    cues = (
        RimCue(seam, 0.5 * head, near=camera_height > 0.5 * head),
        RimCue(bottom.free(), 0.0, near=True),
        RimCue(top, head, near=camera_height < head),
    )
    return tuple(cue for cue in cues if cue.rim.slope.size)
