from dataclasses import replace
from math import pi, radians

import cv2
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, at, paint, pose, rays, true_polar
from vision.detector import Detector
from vision.parameters import VisionParameters
from vision.self_mask import MIN_DEPTH, BodyPart, apply_self_mask, silhouette
from vision.view import EXACT, view_of

SHOULDER = BodyPart(np.array([[0.0, 0.09, 0.38]]), np.array([0.03]))


def outline(view):
    """Image points around the shoulder."""
    return silhouette(SHOULDER.centres, SHOULDER.radii, view_of(CAMERA, view))


def test_a_part_behind_the_camera_is_not_seen() -> None:
    assert not len(outline(pose(-pi / 2, -0.3)))
    assert not len(outline(pose(0.0, 0.0, position=(0.0, 0.09, 0.39))))


def test_only_background_is_hidden() -> None:
    view = pose(pi / 2, -0.5)
    labels = np.zeros((CAMERA.height, CAMERA.width), np.uint8)
    labels[:, ::2] = 3
    assert apply_self_mask((SHOULDER,), labels, view_of(CAMERA, view), 255)
    assert (labels[:, ::2] == 3).all()
    hull = cv2.convexHull(np.rint(outline(view)).astype(np.int32))
    shown = cv2.fillConvexPoly(np.zeros_like(labels), hull, 1)
    assert shown.any()
    assert ((labels[:, 1::2] == 255) == (shown[:, 1::2] == 1)).all()


@given(distance=st.floats(0.32, 0.42), bearing=st.floats(88.0, 92.0))
def test_an_obstacle_behind_the_shoulder_is_located_by_its_upper_edge(distance, bearing) -> None:
    view = pose(radians(80.0), -0.35, position=(0.0, 0.03, 0.47))
    obstacle = at(distance, bearing, "blue", 0.06)
    image = paint([obstacle], view)
    ground = paint([], view)
    # The shoulder as it looks: as grey as the ground, and smaller than what is masked.
    shoulder = replace(SHOULDER, radii=np.array([0.025]))
    shown = np.zeros((CAMERA.height, CAMERA.width), np.uint8)
    assert apply_self_mask((shoulder,), shown, view_of(CAMERA, view), 1)
    image[shown == 1] = ground[shown == 1]
    parameters = VisionParameters(pose=EXACT)
    naive = Detector(CAMERA, parameters).detect(image, view)  # rejected, or too far away
    (aware,) = Detector(CAMERA, parameters, (SHOULDER,)).detect(image, view)
    true_distance, true_bearing = true_polar(obstacle)
    assert all(d.distance > true_distance + 0.03 for d in naive)
    assert abs(aware.distance - true_distance) < 0.015
    assert abs(aware.bearing - true_bearing) < 0.03
    assert aware.cut


CENTRES, RADII = np.array([[0.0, 0.09, 0.38], [0.01, 0.1, 0.25]]), np.array([0.03, 0.045])


@given(pan=st.floats(0.9, 1.7), tilt=st.floats(-0.8, -0.2))
def test_points_lie_beyond_the_tangents_to_their_sphere(pan, tilt):
    """No ray through a point of the polygon meets the sphere, and its corners are not far off."""
    view = pose(pan, tilt, position=(0.0, 0.03, 0.47))
    points = silhouette(CENTRES, RADII, view_of(CAMERA, view))
    for centre, radius, polygon in zip(CENTRES, RADII, points.reshape(-1, 12, 2), strict=False):
        local = (centre - view.position) @ view.rotation
        if local[2] - 1.1 * radius < MIN_DEPTH or np.abs(polygon).max() >= 4096.0:
            continue
        tangents = rays(CAMERA, polygon[:, 0], polygon[:, 1])
        tangents /= np.linalg.norm(tangents, axis=1)[:, None]
        miss = np.linalg.norm(np.cross(tangents, local), axis=1)
        assert (miss > radius).all()
        assert (miss < 1.05 * radius).all()
