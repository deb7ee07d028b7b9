"""The detector: one image and the pose of its camera become detections."""

from collections.abc import Sequence
from dataclasses import replace
from math import sqrt
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from vision.beacon import find_posts
from vision.blob import Blob, find_blobs
from vision.camera import CameraPose, PinholeCamera
from vision.color import OUTSIDE, ColorTable, Labels
from vision.color_file import load_table
from vision.cylinder import (
    Candidate,
    Cylinder,
    RimCue,
    interpenetrate,
    locate,
    polar_in_robot,
)
from vision.detection import Detection
from vision.errors import VisionError
from vision.outline import Outline, trace
from vision.parameters import VisionParameters
from vision.self_mask import BodyPart, hide
from vision.split import split
from vision.value import value
from vision.view import View


@value
class _Sighting:
    """Something that may be one cylinder.

    Attributes:
        kind: obstacle or beacon.
        blobs: of an obstacle one, of a beacon the upper and the lower.
        outline: of the last blob.
        candidate: edges.
        occluded: something hides part of it.
    """

    kind: Literal["obstacle", "beacon"]
    blobs: tuple[Blob, ...]
    outline: Outline
    candidate: Candidate
    occluded: bool


class Detector:
    """Recognises obstacles and beacons in images of one camera.

    Args:
        camera: intrinsics.
        parameters: sizes of things and thresholds.
        self_mask: parts of the robot that the camera may see.

    Raises:
        VisionError: the smallest radius is not below the largest, or the file of the
            colour table is wrong.
    """

    def __init__(
        self,
        camera: PinholeCamera,
        parameters: VisionParameters,
        self_mask: Sequence[BodyPart] = (),
    ) -> None:
        if parameters.min_radius >= parameters.max_radius:
            raise VisionError(
                f"min_radius ({parameters.min_radius}) must be below "
                f"max_radius ({parameters.max_radius})"
            )
        self._camera = camera
        self._parameters = parameters
        self._self_mask = tuple(self_mask)
        path = parameters.color_table
        self._table = load_table(Path(path)) if path else ColorTable()
        self._min_area = tuple(
            parameters.min_area if c.kind == "obstacle" else parameters.min_beacon_area
            for c in self._table.classes
        )
        self._beacon_label = (False, *(c.kind == "beacon" for c in self._table.classes))
        # Mean and standard deviation of a uniform distribution.
        self._radius = (
            0.5 * (parameters.min_radius + parameters.max_radius),
            (parameters.max_radius - parameters.min_radius) / sqrt(12.0),
        )
        self._padded = np.full((camera.height + 2, camera.width + 2), OUTSIDE, dtype=np.uint8)

    def detect(self, image: NDArray[np.uint8], pose: CameraPose) -> tuple[Detection, ...]:
        """What `image` shows, by distance, then label.

        Args:
            image: RGB (height, width, 3).
            pose: of the camera when the image was taken.

        Raises:
            VisionError: the image has not the size of the camera or is not RGB of uint8.
        """
        expected = (self._camera.height, self._camera.width, 3)
        if image.shape != expected:
            raise VisionError(f"the camera gives images of shape {expected}, got {image.shape}")
        labels = self._table.classify(image)
        blobs = find_blobs(labels, self._min_area)
        if not blobs:
            return ()
        inner = self._padded[1:-1, 1:-1]
        inner[:] = labels
        if hide(self._self_mask, inner, camera=self._camera, pose=pose, label=OUTSIDE):
            blobs = [_cut_by_body(blob, inner) for blob in blobs]
        view = View(self._camera, pose)
        outlines = trace(blobs, self._padded, view, self._parameters.edge_sigma)
        sightings = self._obstacles(blobs, outlines, view) + self._beacons(blobs, outlines, view)
        found: list[Detection | None] = []
        parts: list[_Sighting] = []
        # One call for all: its cost hardly depends on their number.
        for sighting, cylinder in zip(sightings, self._locate(sightings, view), strict=True):
            if self._explains(sighting, cylinder):
                found.append(self._detection(sighting, cylinder, view))
            elif sighting.kind == "obstacle":
                pieces = self._split(sighting, view)
                parts += pieces
                if not pieces:
                    found.append(
                        self._detection(
                            *_doubted(sighting, cylinder, self._parameters.covariance_inflation),
                            view,
                        )
                    )
        for sighting, cylinder in self._real(parts, self._locate(parts, view)):
            found.append(self._detection(sighting, cylinder, view))
        return tuple(
            sorted(
                (d for d in found if d is not None),
                key=lambda d: (d.distance, d.label, d.bearing),
            )
        )

    def _obstacles(
        self, blobs: Sequence[Blob], outlines: Sequence[Outline], view: View
    ) -> list[_Sighting]:
        """Blobs of obstacle colours, each taken for one obstacle, if they say enough."""
        head = self._parameters.obstacle_height
        sightings = []
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
            if not (rims or left.trusted or right.trusted):
                continue
            sightings.append(
                _Sighting(
                    "obstacle",
                    (blob,),
                    outline,
                    Candidate(left, right, tuple(rims), head, *self._radius),
                    outline.bottom.covered > self._parameters.max_occlusion_fraction
                    or left.hidden
                    or right.hidden,
                )
            )
        return sightings

    def _beacons(
        self, blobs: Sequence[Blob], outlines: Sequence[Outline], view: View
    ) -> list[_Sighting]:
        """Pairs of blobs of beacon colours that may be beacons."""
        indices = [k for k, blob in enumerate(blobs) if self._beacon_label[blob.label]]
        return [
            _Sighting(
                "beacon",
                (blobs[post.upper], blobs[post.lower]),
                outlines[post.lower],
                post.candidate,
                outlines[post.lower].bottom.covered > self._parameters.max_occlusion_fraction
                or post.candidate.left.hidden
                or post.candidate.right.hidden,
            )
            for post in find_posts(blobs, outlines, indices, view.height, self._parameters)
        ]

    def _split(self, sighting: _Sighting, view: View) -> list[_Sighting]:
        """The obstacles of a blob that is not one obstacle, if they can be told apart."""
        (blob,) = sighting.blobs
        parts = split(
            blob,
            sighting.outline,
            self._padded,
            view=view,
            parameters=self._parameters,
            radius=self._radius,
        )
        return [
            replace(sighting, candidate=part.candidate, occluded=part.occluded) for part in parts
        ]

    def _explains(self, sighting: _Sighting, cylinder: Cylinder) -> bool:
        """Whether one cylinder explains what was seen."""
        p = self._parameters
        if sighting.kind == "beacon":
            return cylinder.misfit < p.beacon_misfit_factor * p.max_misfit
        return cylinder.astray <= p.max_outlier_fraction and cylinder.misfit <= p.max_misfit

    def _real(
        self, parts: Sequence[_Sighting], cylinders: Sequence[Cylinder]
    ) -> list[tuple[_Sighting, Cylinder]]:
        """The plausible parts of split blobs; of two in one place the better seen."""
        ranked = sorted(
            (pair for pair in zip(parts, cylinders, strict=True) if self._plausible(pair[1])),
            key=lambda pair: (-_edges_seen(pair[0].candidate), pair[1].misfit),
        )
        shared = self._parameters.split.min_separation
        real: list[tuple[_Sighting, Cylinder]] = []
        for sighting, cylinder in ranked:
            if not any(interpenetrate(cylinder, other, shared) for _, other in real):
                real.append((sighting, cylinder))
        return real

    def _plausible(self, cylinder: Cylinder) -> bool:
        """Whether a part of a blob is like one obstacle."""
        p = self._parameters
        slack = p.split.radius_margin * (p.max_radius - p.min_radius)
        return (
            cylinder.misfit < p.split.misfit_factor * p.max_misfit
            and p.min_radius - slack < cylinder.radius < p.max_radius + slack
        )

    def _locate(self, sightings: Sequence[_Sighting], view: View) -> list[Cylinder]:
        parameters = self._parameters
        return locate(
            [sighting.candidate for sighting in sightings],
            view,
            parameters.roundness_sigma,
            parameters.edge_correlation,
            0.5 * parameters.outline_step / parameters.edge_sigma,
        )

    def _detection(self, sighting: _Sighting, cylinder: Cylinder, view: View) -> Detection | None:
        """Detection of a located cylinder; None if it is too far or too uncertain."""
        parameters = self._parameters
        beacon = sighting.kind == "beacon"
        limit = parameters.max_beacon_range if beacon else parameters.max_obstacle_range
        if not beacon:
            cylinder = _somewhere_within(cylinder, parameters.max_radius, self._radius[0])
        distance, bearing, covariance, by_radius = polar_in_robot(cylinder, view)
        sure = covariance[0, 0] <= (parameters.max_relative_sigma * distance) ** 2
        if not (distance <= limit and sure):  # what is not a number is neither
            return None
        blobs = sighting.blobs
        return Detection(
            kind=sighting.kind,
            label="/".join(self._table.classes[blob.label - 1].name for blob in blobs),
            bearing=bearing,
            distance=distance,
            covariance=covariance,
            radius=cylinder.radius,
            radius_sigma=sqrt(float(cylinder.covariance[2, 2])),
            by_radius=by_radius,
            cut=any(blob.cut for blob in blobs),
            occluded=sighting.occluded,
            box=_around(blobs),
        )


def _around(blobs: tuple[Blob, ...]) -> tuple[int, int, int, int]:
    """Box around all of `blobs`."""
    if len(blobs) == 1:
        return blobs[0].box
    lefts, tops, rights, bottoms = zip(*(blob.box for blob in blobs), strict=True)
    return min(lefts), min(tops), max(rights), max(bottoms)


def _doubted(sighting: _Sighting, cylinder: Cylinder, least: float) -> tuple[_Sighting, Cylinder]:
    """A cylinder that does not explain its edges: taken for occluded, believed less.

    Args:
        sighting: of it.
        cylinder: as located.
        least: growth of its covariance.
    """
    factor = max(least, 0.5 * cylinder.misfit)
    return (
        replace(sighting, occluded=True),
        replace(cylinder, covariance=factor * cylinder.covariance),
    )


def _somewhere_within(cylinder: Cylinder, thickest: float, typical: float) -> Cylinder:
    """What is thicker than any obstacle is one with something else: it stands anywhere in it.

    Args:
        cylinder: as located.
        thickest: largest radius of an obstacle [m].
        typical: mean radius of an obstacle [m].
    """
    if cylinder.radius <= thickest + 2.0 * sqrt(float(cylinder.covariance[2, 2])):
        return cylinder
    slack = cylinder.radius - typical
    spread = np.diag([(slack / cylinder.distance) ** 2, slack * slack, slack * slack])
    return replace(cylinder, covariance=cylinder.covariance + spread)


def _cut_by_body(blob: Blob, labels: Labels) -> Blob:
    """`blob`, which counts as cut at the bottom where it meets the robot's own body."""
    left, top, right, bottom = blob.box
    around = labels[max(top - 1, 0) : bottom + 1, max(left - 1, 0) : right + 1]
    if not (around == OUTSIDE).any():
        return blob
    return replace(blob, touches=(*blob.touches[:3], True))


def _edges_seen(candidate: Candidate) -> int:
    """How many edges locate a candidate."""
    return len(candidate.rims) + candidate.left.trusted + candidate.right.trusted
