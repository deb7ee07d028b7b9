"""Location of the cylinders of an image: edges of blobs, candidates, segmentation, fit."""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.candidates import candidates_of
from vision.cylinder import interpenetrate
from vision.cylinder_fit import fit
from vision.outline import trace
from vision.split import split
from vision.tables import OUTSIDE

Bools = NDArray[np.bool_]
Labels = NDArray[np.uint8]
Rows = NDArray[np.record]
Table = NDArray[np.int32]

SIGMAS = 2.0  # tolerance of the distance between two parts of one cylinder [standard deviations]


@compiled
def locate(
    blobs: Rows,
    runs: Table,
    extents: Table,
    padded: Labels,
    masked: bool,
    views: Rows,
    beacon: Bools,
    parameters: Rows,
) -> tuple[Rows, Rows]:
    """Return the candidates of an image and the parts of its merged blobs.

    Args:
        blobs: see `find_blobs`; sides, rims and cuts by the self mask are set.
        runs: runs of all blobs.
        extents: extents of all blobs.
        padded: labels of the image with a border of `OUTSIDE` one pixel wide (h + 2, w + 2).
        masked: whether there may be a self mask.
        views: record of type `View` (1,).
        beacon: whether each colour class is one of beacons, by label.
        parameters: parameters (1,).

    Returns:
        Candidates and parts, records of type `Candidate`, of which some are reported.
    """
    view, p = views[0], parameters[0]
    if masked:
        for k in range(len(blobs)):
            blobs[k].cut = blobs[k].cut or _masked(blobs[k].box, padded)
    points = trace(blobs, extents, padded, view, p.edge_sigma)
    candidates = candidates_of(blobs, points, beacon, view.position[2], p)
    fit(candidates, points, view, p)
    rejected = np.empty(len(candidates), np.int64)
    count = 0
    for k in range(len(candidates)):
        candidate = candidates[k]
        obstacle = candidate.upper == candidate.lower
        candidate.reported = _consistent(candidate, obstacle, p)
        if obstacle and not candidate.reported:
            rejected[count] = k
            count += 1
    rejected = rejected[:count]
    parts, part_points, counts = split(candidates, rejected, blobs, runs, padded, view, p)
    fit(parts, part_points, view, p)
    _select(parts, p)
    for i in range(count):
        if counts[i] == 0:
            _inflate(candidates[rejected[i]], p)
    return candidates, parts


@compiled
def _masked(box: Table, padded: Labels) -> bool:
    """Return whether a pixel in or next to a box is in the self mask or outside the image."""
    for row in range(box[1], box[3] + 2):
        for column in range(box[0], box[2] + 2):
            if padded[row, column] == OUTSIDE:
                return True
    return False


@compiled
def _consistent(candidate: np.record, obstacle: bool, p: np.record) -> bool:
    """Return whether the edges are consistent with one cylinder."""
    if not obstacle:
        return bool(candidate.misfit < p.beacon_misfit_factor * p.max_misfit)
    few_outliers = candidate.outlier_fraction <= p.max_outlier_fraction
    return bool(few_outliers and candidate.misfit <= p.max_misfit)


@compiled
def _inflate(candidate: np.record, p: np.record) -> None:
    """Report an inconsistent candidate as occluded, with a larger covariance."""
    candidate.occluded = candidate.reported = True
    inflation = max(p.covariance_inflation, 0.5 * candidate.misfit)
    covariance = candidate.covariance
    for i in range(3):
        for j in range(3):
            covariance[i, j] *= inflation


@compiled
def _select(parts: Rows, p: np.record) -> None:
    """Report the plausible parts of merged blobs; of two that interpenetrate the more certain."""
    margin = p.radius_margin * (p.max_radius - p.min_radius)
    ranked, count = np.empty(len(parts), np.int64), 0
    for k in range(len(parts)):
        radius, variance = parts[k].cylinder[2], parts[k].covariance[1, 1]
        if not (
            _consistent(parts[k], True, p)
            and p.min_radius - margin < radius < p.max_radius + margin
        ):
            continue
        j = count
        while j > 0 and variance < parts[ranked[j - 1]].covariance[1, 1]:
            ranked[j] = ranked[j - 1]
            j -= 1
        ranked[j] = k
        count += 1
    for i in range(count):
        part = parts[ranked[i]]
        part.reported = True
        tolerance = SIGMAS * sqrt(part.covariance[1, 1])
        for j in range(i):
            other = parts[ranked[j]]
            if other.reported and interpenetrate(
                part.cylinder, other.cylinder, tolerance, p.min_separation
            ):
                part.reported = False
                break
