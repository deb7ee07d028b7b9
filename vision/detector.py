"""The detector: one image and the pose of its camera become detections."""

from collections.abc import Sequence
from dataclasses import replace
from math import sqrt
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from vision.beacon import Post, find_posts
from vision.blob import Blob, find_blobs
from vision.camera import CameraPose, PinholeCamera
from vision.colour import OUTSIDE, ColourTable
from vision.cylinder import Candidate, Cylinder, RimCue, locate, polar_in_robot
from vision.detection import Detection
from vision.errors import VisionError
from vision.outline import Outline, trace
from vision.parameters import VisionParameters
from vision.split import Part, split
from vision.view import View

COVERED = 0.1  # share of a rim next to another colour that makes a blob occluded
ASTRAY = 0.2  # share of rim points off one cylinder's rim that shows another one
DOUBT = 4.0  # the covariance of what fits badly grows at least so many times
BEACON_MISFIT = 2.0  # beacons may misfit so many times more than one obstacle


class Detector:
    """Recognises obstacles and beacons in images of one camera.

    Args:
        camera: intrinsics.
        parameters: sizes of things and thresholds.

    Raises:
        VisionError: the smallest radius is not below the largest.
    """

    def __init__(self, camera: PinholeCamera, parameters: VisionParameters) -> None:
        if parameters.min_radius >= parameters.max_radius:
            raise VisionError(
                f"min_radius ({parameters.min_radius}) must be below "
                f"max_radius ({parameters.max_radius})"
            )
        self._camera = camera
        self._parameters = parameters
        self._table = ColourTable()
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
        self._padded[1:-1, 1:-1] = labels
        view = View(self._camera, pose)
        outlines = trace(blobs, self._padded, view, self._parameters.edge_sigma)
        found = self._obstacles(blobs, outlines, view) + self._beacons(blobs, outlines, view)
        return tuple(sorted(found, key=lambda d: (d.distance, d.label, d.bearing)))

    def _obstacles(
        self, blobs: Sequence[Blob], outlines: Sequence[Outline], view: View
    ) -> list[Detection]:
        """Detections of obstacles."""
        chosen = []
        candidates = []
        for k, blob in enumerate(blobs):
            if self._beacon_label[blob.label]:
                continue
            candidate = self._obstacle(outlines[k], view)
            if candidate is not None:
                chosen.append(k)
                candidates.append(candidate)
        found = []
        parts: list[tuple[Blob, Part]] = []
        cylinders = self._locate(candidates, view)
        for k, candidate, cylinder in zip(chosen, candidates, cylinders, strict=True):
            outline, blob = outlines[k], blobs[k]
            doubtful = cylinder.astray > ASTRAY or cylinder.misfit > self._parameters.max_misfit
            if doubtful:
                pieces = split(
                    blob,
                    outline,
                    self._padded,
                    view=view,
                    parameters=self._parameters,
                    radius=self._radius,
                )
                if pieces:
                    parts += [(blob, piece) for piece in pieces]
                    continue
            occluded = (
                doubtful
                or outline.bottom.covered > COVERED
                or candidate.left.hidden
                or candidate.right.hidden
            )
            found.append(
                self._detection(
                    "obstacle",
                    self._doubted(cylinder) if doubtful else cylinder,
                    view,
                    (blob,),
                    occluded,
                )
            )
        cylinders = self._locate([part.candidate for _, part in parts], view)
        for (blob, part), cylinder in zip(parts, cylinders, strict=True):
            if self._plausible(cylinder):
                found.append(self._detection("obstacle", cylinder, view, (blob,), part.occluded))
        return [d for d in found if d is not None]

    def _plausible(self, cylinder: Cylinder) -> bool:
        """Whether a part of a blob is like one obstacle."""
        parameters = self._parameters
        slack = 0.3 * (parameters.max_radius - parameters.min_radius)
        return (
            cylinder.misfit < parameters.max_misfit
            and parameters.min_radius - slack < cylinder.radius < parameters.max_radius + slack
        )

    def _doubted(self, cylinder: Cylinder) -> Cylinder:
        """A cylinder that does not explain its edges, believed so much less."""
        factor = max(DOUBT, cylinder.misfit / 2.0)
        return replace(cylinder, covariance=factor * cylinder.covariance)

    def _obstacle(self, outline: Outline, view: View) -> Candidate | None:
        """Edges of a blob taken for one obstacle; None if they say too little."""
        rims = []
        if outline.bottom.slope.size:
            rims.append(RimCue(outline.bottom, 0.0, near=True))
        height = self._parameters.obstacle_height
        if outline.top.slope.size and view.height > height:
            rims.append(RimCue(outline.top, height, near=False))
        left, right = outline.left, outline.right
        if not rims and not (left.trusted and right.trusted):
            return None
        return Candidate(left, right, tuple(rims), *self._radius)

    def _beacons(
        self, blobs: Sequence[Blob], outlines: Sequence[Outline], view: View
    ) -> list[Detection]:
        """Detections of beacons."""
        indices = [k for k, blob in enumerate(blobs) if self._beacon_label[blob.label]]
        posts = find_posts(blobs, outlines, indices, view.height, self._parameters)
        limit = BEACON_MISFIT * self._parameters.max_misfit
        cylinders = self._locate([post.candidate for post in posts], view)
        found = [
            self._beacon(blobs, outlines, post, cylinder, view)
            for post, cylinder in zip(posts, cylinders, strict=True)
            if cylinder.misfit < limit
        ]
        return [d for d in found if d is not None]

    def _beacon(
        self,
        blobs: Sequence[Blob],
        outlines: Sequence[Outline],
        post: Post,
        cylinder: Cylinder,
        view: View,
    ) -> Detection | None:
        upper, lower = blobs[post.upper], blobs[post.lower]
        candidate = post.candidate
        occluded = (
            outlines[post.lower].bottom.covered > COVERED
            or candidate.left.hidden
            or candidate.right.hidden
        )
        return self._detection("beacon", cylinder, view, (upper, lower), occluded)

    def _locate(self, candidates: Sequence[Candidate], view: View) -> list[Cylinder]:
        parameters = self._parameters
        return locate(
            candidates,
            view,
            parameters.roundness_sigma,
            0.5 * parameters.step / parameters.edge_sigma,
        )

    def _detection(
        self,
        kind: Literal["obstacle", "beacon"],
        cylinder: Cylinder,
        view: View,
        blobs: Sequence[Blob],
        occluded: bool,
    ) -> Detection | None:
        """Detection of a located cylinder; None if it is too far or too uncertain."""
        parameters = self._parameters
        limit = parameters.beacon_range if kind == "beacon" else parameters.obstacle_range
        distance, bearing, covariance = polar_in_robot(cylinder, view)
        if distance > limit or covariance[0, 0] > (parameters.max_relative_sigma * distance) ** 2:
            return None
        boxes = [blob.box for blob in blobs]
        return Detection(
            kind=kind,
            label="/".join(self._table.classes[blob.label - 1].name for blob in blobs),
            bearing=bearing,
            distance=distance,
            covariance=covariance,
            radius=cylinder.radius,
            radius_sigma=sqrt(float(cylinder.covariance[2, 2])),
            cut=any(blob.cut for blob in blobs),
            occluded=occluded,
            box=(
                min(b[0] for b in boxes),
                min(b[1] for b in boxes),
                max(b[2] for b in boxes),
                max(b[3] for b in boxes),
            ),
        )
