"""Detector of obstacles and beacons in an image."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from math import sqrt
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from compilation.record import record
from vision.blob import find_blobs
from vision.camera import CameraPose, PinholeCamera
from vision.color import ColorTable, load_table
from vision.cylinder import polar_in_robot
from vision.detection import Detection
from vision.errors import VisionError
from vision.location import locate
from vision.parameters import VisionParameters
from vision.self_mask import BodyPart, apply_self_mask
from vision.sizes import Sizes
from vision.tables import OUTSIDE
from vision.view import view_of

Rows = NDArray[np.record]

SIZES = Sizes()
FIELDS = ("upper", "lower", "occluded", "cylinder", "covariance")  # that detections are made of


class Detector:
    """Detector of obstacles and beacons in the images of one camera.

    Args:
        camera: intrinsics.
        parameters: error models and thresholds.
        self_mask: parts of the robot that the camera may see.
        shutter: exposure time, for the error of edges by motion blur [s].
        sizes: sizes of the obstacles and beacons.

    Raises:
        VisionError: the file of the colour table is invalid.
    """

    def __init__(
        self,
        camera: PinholeCamera,
        parameters: VisionParameters,
        self_mask: Sequence[BodyPart] = (),
        shutter: float = 0.0,
        sizes: Sizes = SIZES,
    ) -> None:
        self._camera = camera
        self._sizes = sizes
        self._parameters = parameters
        self._self_mask = tuple(self_mask)
        self._shutter = shutter
        path = parameters.color_table
        self._table = load_table(Path(path)) if path else ColorTable()
        classes = self._table.classes
        self._beacon = np.array([False, *(c.kind == "beacon" for c in classes)])
        areas = np.where(self._beacon, parameters.min_beacon_area, parameters.min_area)
        self._min_area = areas[1:].astype(np.int32)
        self._record = parameter_record(parameters, sizes)
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
        blobs, runs, extents = find_blobs(labels, self._min_area)
        if not len(blobs):
            return ()
        p, padded = self._parameters, self._padded
        padded[1:-1, 1:-1] = labels
        view = view_of(self._camera, pose, p.pose, self._shutter, p.unit)
        masked = apply_self_mask(self._self_mask, padded[1:-1, 1:-1], view, OUTSIDE)
        tables = locate(blobs, runs, extents, padded, masked, view, self._beacon, self._record)
        detections = self._detections(np.concatenate(tables), blobs, view)
        return tuple(sorted(detections, key=lambda d: (d.distance, d.label, d.bearing)))

    def _detections(self, candidates: Rows, blobs: Rows, view: Rows) -> Iterator[Detection]:
        """Yield the detections of the reported candidates that are near and certain enough."""
        p, sizes, classes = self._parameters, self._sizes, self._table.classes
        camera = (*view["position"][0, :2].tolist(), float(view["heading"][0]))
        boxes, labels, cuts = (blobs[name].tolist() for name in ("box", "label", "cut"))
        columns = (candidates[name][candidates["reported"]].tolist() for name in FIELDS)
        for i, j, occluded, cylinder, covariance in zip(*columns, strict=True):
            beacon = i != j
            radius, variance = cylinder[2], covariance[2][2]
            if not beacon and radius > sizes.obstacle_radius[1] + 2.0 * sqrt(variance):
                # An obstacle merged with another object; it is somewhere in the blob.
                excess = radius - sizes.radius_prior[0]
                spread = (excess / cylinder[1]) ** 2, excess * excess, excess * excess
                for k in range(3):
                    covariance[k][k] += spread[k]
            distance, bearing, polar, by_radius = polar_in_robot(cylinder, covariance, camera)
            certain = polar[0, 0] <= (p.max_relative_sigma * distance) ** 2
            limit = p.max_beacon_range if beacon else p.max_obstacle_range
            if not (distance <= limit and certain):  # also if NaN
                continue
            (left, top, right, bottom), other = boxes[i], boxes[j]
            label = classes[labels[i] - 1].name
            yield Detection(
                kind="beacon" if beacon else "obstacle",
                label=f"{label}/{classes[labels[j] - 1].name}" if beacon else label,
                bearing=bearing,
                distance=distance,
                covariance=polar,
                radius=radius,
                radius_sigma=sqrt(covariance[2][2]),
                by_radius=by_radius,
                cut=cuts[i] or cuts[j],
                occluded=occluded,
                box=(
                    min(left, other[0]),
                    min(top, other[1]),
                    max(right, other[2]),
                    max(bottom, other[3]),
                ),
            )


def parameter_record(parameters: VisionParameters, sizes: Sizes = SIZES) -> Rows:
    """Return the numbers of the parameters, those of the segmentation included, and sizes (1,).

    `radius` and `radius_sigma` are the prior of an obstacle's radius.
    """
    radius, sigma = sizes.radius_prior
    return record(
        parameters,
        obstacle_height=sizes.top,
        height_sigma=sizes.height_sigma,
        min_radius=sizes.obstacle_radius[0],
        max_radius=sizes.obstacle_radius[1],
        beacon_height=sizes.beacon_height,
        beacon_radius=sizes.beacon_radius,
        radius=radius,
        radius_sigma=max(sigma, parameters.known_radius_sigma),
        **asdict(parameters.split),
    )
