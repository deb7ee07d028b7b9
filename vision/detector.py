"""Detector of obstacles and beacons in an image."""

from collections.abc import Sequence
from dataclasses import replace
from math import sqrt
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from vision.beacon import find_posts
from vision.blob import Blob, find_blobs
from vision.camera import CameraPose, PinholeCamera
from vision.color import OUTSIDE, ColorTable, Labels, load_table
from vision.cylinder import Candidate, Cylinder, RimCue, interpenetrate, locate, polar_in_robot
from vision.detection import Detection
from vision.errors import VisionError
from vision.outline import Outline, trace
from vision.parameters import VisionParameters
from vision.self_mask import BodyPart, apply_self_mask
from vision.split import split
from vision.view import View


@value
class _Hypothesis:
    """Hypothesis of one cylinder.

    Attributes:
        kind: obstacle or beacon.
        blobs: one of an obstacle, upper and lower of a beacon.
        outline: outline of the last blob.
        candidate: edges.
        occluded: whether it is partly occluded.
    """

    kind: Literal["obstacle", "beacon"]
    blobs: tuple[Blob, ...]
    outline: Outline
    candidate: Candidate
    occluded: bool


class Detector:
    """Detector of obstacles and beacons in the images of one camera.

    Args:
        camera: intrinsics.
        parameters: sizes, error models and thresholds.
        self_mask: parts of the robot that the camera may see.
        shutter: exposure time, for the error of edges by motion blur [s].

    Raises:
        VisionError: min_radius is not below max_radius, or the file of the colour table is
            invalid.
    """

    def __init__(
        self,
        camera: PinholeCamera,
        parameters: VisionParameters,
        self_mask: Sequence[BodyPart] = (),
        shutter: float = 0.0,
    ) -> None:
        if parameters.min_radius >= parameters.max_radius:
            raise VisionError(
                f"min_radius: not below max_radius, got {parameters.min_radius}; "
                f"expected less than {parameters.max_radius}"
            )
        self._camera = camera
        self._parameters = parameters
        self._self_mask = tuple(self_mask)
        self._shutter = shutter
        path = parameters.color_table
        self._table = load_table(Path(path)) if path else ColorTable()
        self._min_area = tuple(
            parameters.min_area if c.kind == "obstacle" else parameters.min_beacon_area
            for c in self._table.classes
        )
        self._beacon_label = (False, *(c.kind == "beacon" for c in self._table.classes))
        self._padded = np.full((camera.height + 2, camera.width + 2), OUTSIDE, dtype=np.uint8)

    def detect(self, image: NDArray[np.uint8], pose: CameraPose) -> tuple[Detection, ...]:
        """Return the detections in `image`, by distance, then label.

        Args:
            image: RGB (height, width, 3).
            pose: pose of the camera at capture.

        Raises:
            VisionError: the image does not have the size of the camera or is not RGB of uint8.
        """
        expected = (self._camera.height, self._camera.width, 3)
        if image.shape != expected:
            raise VisionError(f"image: wrong shape, got {image.shape}; expected {expected}")
        labels = self._table.classify(image)
        blobs = find_blobs(labels, self._min_area)
        if not blobs:
            return ()
        inner = self._padded[1:-1, 1:-1]
        inner[:] = labels
        if apply_self_mask(self._self_mask, inner, camera=self._camera, pose=pose, label=OUTSIDE):
            blobs = [_cut_by_self_mask(blob, inner) for blob in blobs]
        view = View(self._camera, pose, self._parameters.pose, self._shutter)
        outlines = trace(blobs, self._padded, view, self._parameters.edge_sigma)
        hypotheses = self._obstacles(blobs, outlines, view) + self._beacons(blobs, outlines, view)
        detections: list[Detection | None] = []
        parts: list[_Hypothesis] = []
        # One call for all: its cost hardly depends on their number.
        for hypothesis, cylinder in zip(hypotheses, self._locate(hypotheses, view), strict=True):
            if self._consistent(hypothesis, cylinder):
                detections.append(self._detection(hypothesis, cylinder, view))
            elif hypothesis.kind == "obstacle":
                pieces = self._split(hypothesis, view)
                parts += pieces
                if not pieces:
                    detections.append(self._detection(*self._inflated(hypothesis, cylinder), view))
        for hypothesis, cylinder in self._deduplicated(parts, self._locate(parts, view)):
            detections.append(self._detection(hypothesis, cylinder, view))
        return tuple(
            sorted(
                (d for d in detections if d is not None),
                key=lambda d: (d.distance, d.label, d.bearing),
            )
        )

    def _obstacles(
        self, blobs: Sequence[Blob], outlines: Sequence[Outline], view: View
    ) -> list[_Hypothesis]:
        """Return one hypothesis per blob of an obstacle colour with at least one usable edge."""
        head = self._parameters.obstacle_height
        hypotheses = []
        for blob, outline in zip(blobs, outlines, strict=True):
            if self._beacon_label[blob.label]:
                continue
            rims = []
            bottom = outline.bottom.free()
            if bottom.slope.size:
                rims.append(RimCue(bottom, 0.0, near=True))
            if outline.top.slope.size and view.height > head:
                rims.append(RimCue(outline.top, head, near=False))
            left, right = outline.left, outline.right
            if rims or left.trusted or right.trusted:
                candidate = Candidate(
                    left, right, tuple(rims), head, *self._parameters.radius_prior
                )
                occluded = self._occluded(outline, candidate)
                hypotheses.append(_Hypothesis("obstacle", (blob,), outline, candidate, occluded))
        return hypotheses

    def _beacons(
        self, blobs: Sequence[Blob], outlines: Sequence[Outline], view: View
    ) -> list[_Hypothesis]:
        """Return one hypothesis per pair of stacked blobs of beacon colours."""
        indices = [k for k, blob in enumerate(blobs) if self._beacon_label[blob.label]]
        return [
            _Hypothesis(
                "beacon",
                (blobs[post.upper], blobs[post.lower]),
                outlines[post.lower],
                post.candidate,
                self._occluded(outlines[post.lower], post.candidate),
            )
            for post in find_posts(blobs, outlines, indices, view.height, self._parameters)
        ]

    def _occluded(self, outline: Outline, candidate: Candidate) -> bool:
        return (
            outline.bottom.occlusion_fraction > self._parameters.max_occlusion_fraction
            or candidate.left.occluded
            or candidate.right.occluded
        )

    def _split(self, hypothesis: _Hypothesis, view: View) -> list[_Hypothesis]:
        """Return the obstacles of a merged blob, empty if it cannot be segmented."""
        (blob,) = hypothesis.blobs
        parts = split(blob, hypothesis.outline, self._padded, view, self._parameters)
        return [
            replace(hypothesis, candidate=part.candidate, occluded=part.occluded) for part in parts
        ]

    def _consistent(self, hypothesis: _Hypothesis, cylinder: Cylinder) -> bool:
        """Return whether the edges are consistent with one cylinder."""
        p = self._parameters
        if hypothesis.kind == "beacon":
            return cylinder.misfit < p.beacon_misfit_factor * p.max_misfit
        return (
            cylinder.outlier_fraction <= p.max_outlier_fraction and cylinder.misfit <= p.max_misfit
        )

    def _deduplicated(
        self, parts: Sequence[_Hypothesis], cylinders: Sequence[Cylinder]
    ) -> list[tuple[_Hypothesis, Cylinder]]:
        """Return the plausible parts of merged blobs; of two that interpenetrate the better one."""
        ranked = sorted(
            (pair for pair in zip(parts, cylinders, strict=True) if self._plausible(pair[1])),
            key=lambda pair: (-_edge_count(pair[0].candidate), pair[1].misfit),
        )
        separation = self._parameters.split.min_separation
        kept: list[tuple[_Hypothesis, Cylinder]] = []
        for hypothesis, cylinder in ranked:
            if not any(interpenetrate(cylinder, other, separation) for _, other in kept):
                kept.append((hypothesis, cylinder))
        return kept

    def _inflated(
        self, hypothesis: _Hypothesis, cylinder: Cylinder
    ) -> tuple[_Hypothesis, Cylinder]:
        """Mark an inconsistent hypothesis as occluded and inflate its covariance."""
        inflation = max(self._parameters.covariance_inflation, 0.5 * cylinder.misfit)
        return (
            replace(hypothesis, occluded=True),
            replace(cylinder, covariance=inflation * cylinder.covariance),
        )

    def _plausible(self, cylinder: Cylinder) -> bool:
        """Return whether misfit and radius of a part are those of an obstacle."""
        p = self._parameters
        margin = p.split.radius_margin * (p.max_radius - p.min_radius)
        return (
            cylinder.misfit < p.split.misfit_factor * p.max_misfit
            and p.min_radius - margin < cylinder.radius < p.max_radius + margin
        )

    def _locate(self, hypotheses: Sequence[_Hypothesis], view: View) -> list[Cylinder]:
        parameters = self._parameters
        return locate(
            [hypothesis.candidate for hypothesis in hypotheses],
            view,
            parameters.roundness_sigma,
            parameters.edge_correlation,
            0.5 * parameters.outline_step / parameters.edge_sigma,
            unit=parameters.unit,
        )

    def _detection(
        self, hypothesis: _Hypothesis, cylinder: Cylinder, view: View
    ) -> Detection | None:
        """Return the detection of a cylinder, None if it is too far or too uncertain."""
        parameters = self._parameters
        beacon = hypothesis.kind == "beacon"
        limit = parameters.max_beacon_range if beacon else parameters.max_obstacle_range
        if not beacon:
            cylinder = _inflated_if_too_wide(cylinder, parameters)
        distance, bearing, covariance, by_radius = polar_in_robot(cylinder, view)
        certain = covariance[0, 0] <= (parameters.max_relative_sigma * distance) ** 2
        if not (distance <= limit and certain):  # also if NaN
            return None
        blobs = hypothesis.blobs
        return Detection(
            kind=hypothesis.kind,
            label="/".join(self._table.classes[blob.label - 1].name for blob in blobs),
            bearing=bearing,
            distance=distance,
            covariance=covariance,
            radius=cylinder.radius,
            radius_sigma=sqrt(float(cylinder.covariance[2, 2])),
            by_radius=by_radius,
            cut=any(blob.cut for blob in blobs),
            occluded=hypothesis.occluded,
            box=_bounding_box(blobs),
        )


def _bounding_box(blobs: tuple[Blob, ...]) -> tuple[int, int, int, int]:
    lefts, tops, rights, bottoms = zip(*(blob.box for blob in blobs), strict=True)
    return min(lefts), min(tops), max(rights), max(bottoms)


def _inflated_if_too_wide(cylinder: Cylinder, parameters: VisionParameters) -> Cylinder:
    """Inflate the covariance of a cylinder wider than any obstacle.

    The blob is an obstacle merged with another object; the obstacle is somewhere in it.
    """
    if cylinder.radius <= parameters.max_radius + 2.0 * sqrt(float(cylinder.covariance[2, 2])):
        return cylinder
    excess = cylinder.radius - parameters.radius_prior[0]
    spread = np.diag([(excess / cylinder.distance) ** 2, excess * excess, excess * excess])
    return replace(cylinder, covariance=cylinder.covariance + spread)


def _cut_by_self_mask(blob: Blob, labels: Labels) -> Blob:
    """Mark a blob that touches the self mask as cut at the bottom."""
    left, top, right, bottom = blob.box
    around = labels[max(top - 1, 0) : bottom + 1, max(left - 1, 0) : right + 1]
    if not (around == OUTSIDE).any():
        return blob
    return replace(blob, touches=(*blob.touches[:3], True))


def _edge_count(candidate: Candidate) -> int:
    """Return the number of usable edges."""
    return len(candidate.rims) + candidate.left.trusted + candidate.right.trusted
