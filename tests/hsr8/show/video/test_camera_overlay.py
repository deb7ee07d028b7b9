from types import SimpleNamespace

import numpy as np
import pytest

from hsr8.recording import palette
from hsr8.show.video.camera_overlay import CameraOverlay
from vision.camera import PinholeCamera

CAMERA = PinholeCamera.from_vertical_fov(320, 240, np.radians(60.0))
FOCAL = CAMERA.focal
AWAY = {"head": (1.5, 0.0), "gaze": (-1.5, 0.0)}  # chosen behind the camera: no window is drawn


@pytest.fixture
def summary(shown):
    frame = vars(shown())

    def changed(**change):
        return SimpleNamespace(**frame | change)

    return changed


def _drawn(frame, size=(320, 240)):
    image = np.zeros((size[1], size[0], 3), np.uint8)
    CameraOverlay(CAMERA, size).draw(image, frame)
    return image


def _strokes(image):
    """Rows and columns of the yellow strokes, whose edges are smooth."""
    return np.nonzero(np.abs(image - np.array(palette.VIEW)).sum(axis=-1) < 150)


def _cross(image):
    """Middle of the window; its corners lie far from it."""
    rows, columns = _strokes(image[70:170, 110:210])
    return 110 + 0.5 * (columns.min() + columns.max()), 70 + 0.5 * (rows.min() + rows.max())


@pytest.mark.parametrize("tilt", [0.0, -0.1])
def test_the_window_of_a_reached_gaze_is_centred(summary, tilt):
    frame = summary(detections=(), head=(0.2, tilt), gaze=(0.2, tilt))
    image = _drawn(frame)
    rows, columns = _strokes(image)
    assert 0.5 * (columns.min() + columns.max()) == pytest.approx(160, abs=1)
    assert _cross(image) == pytest.approx((160, 120), abs=1)
    assert 0.6 * 240 < rows.max() - rows.min() < 0.98 * 240


def test_the_window_follows_the_pinhole_projection(summary):
    left = _cross(_drawn(summary(detections=(), head=(0.0, 0.0), gaze=(0.1, 0.0))))
    assert left[0] == pytest.approx(160 - FOCAL * np.tan(0.1), abs=4)
    up = _cross(_drawn(summary(detections=(), head=(0.0, 0.0), gaze=(0.0, 0.1))))
    assert up[1] == pytest.approx(120 - FOCAL * np.tan(0.1), abs=4)


def test_a_gaze_behind_the_camera_is_not_drawn(summary):
    assert not _drawn(summary(detections=(), **AWAY)).any()


@pytest.mark.parametrize("scale", [1, 2])
def test_boxes_match_the_detections(summary, scale):
    frame = summary(**AWAY)
    image = _drawn(frame, (320 * scale, 240 * scale))
    inside = image[84 * scale : 156 * scale, 104 * scale : 136 * scale]
    assert not inside.any()
    assert image[81 * scale : 159 * scale, 100 * scale].any(axis=-1).all()
    assert image[160 * scale, 101 * scale : 139 * scale].any(axis=-1).all()
    assert not image[170 * scale :].any()


def test_a_wider_image_shows_more_at_both_sides(summary):
    """The image of vision fills the height and is centred."""
    wide = _drawn(summary(**AWAY), (480, 240))
    assert np.array_equal(wide[100:, 80:400], _drawn(summary(**AWAY))[100:])
