from types import SimpleNamespace

import numpy as np
import pytest

from hsr8.recording import palette
from hsr8.show.video.gaze_panel import GazePanel

PAN, TILTS = np.radians(90.0), (np.radians(-60.0), np.radians(20.0))


@pytest.fixture
def frame(shown):
    return shown()


def _drawn(frame):
    panel = GazePanel(300, PAN, TILTS)
    image = np.full((panel.size[1] + 40, 360, 3), 90, np.uint8)
    panel.draw(image, (30, 20), frame)
    return image, panel


def replaced(frame, **change):
    return SimpleNamespace(**vars(frame) | change)


def _chosen(image):
    rows, columns = np.nonzero((image == palette.BELIEF).all(axis=-1))
    return columns.mean(), rows.mean()


def test_the_panel_stays_within_its_rectangle(frame):
    image, panel = _drawn(frame)
    inside = np.zeros(image.shape[:2], bool)
    inside[20 : 20 + panel.size[1], 30 : 30 + panel.size[0]] = True
    assert (image[~inside] == 90).all()
    assert (image[inside] != 90).any(axis=-1).mean() > 0.99


def test_left_and_up_of_the_head_are_left_and_up(frame):
    middle = _chosen(_drawn(replaced(frame, gaze=(0.0, -0.35)))[0])
    left = _chosen(_drawn(replaced(frame, gaze=(0.8, -0.35)))[0])
    up = _chosen(_drawn(replaced(frame, gaze=(0.0, 0.1)))[0])
    assert middle[0] == pytest.approx(180, abs=2)
    assert left[0] < middle[0] - 50
    assert up[1] < middle[1] - 20


def test_a_gaze_beyond_the_map_is_drawn_at_its_rim(frame):
    far = _chosen(_drawn(replaced(frame, gaze=(3.0, -0.35)))[0])
    rim = _chosen(_drawn(replaced(frame, gaze=(PAN, -0.35)))[0])
    assert far == pytest.approx(rim)


def test_evaluations_are_bars_of_proportional_length(frame):
    def filled(psi):
        image = _drawn(replaced(frame, psi=psi))[0]
        return int((image == palette.VIEW).all(axis=-1).sum())

    full = filled((1.0, 1.0, 1.0, 1.0))
    assert filled((0.0, 0.0, 0.0, 0.0)) == 0
    assert filled((0.5, 0.5, 0.5, 0.5)) == pytest.approx(0.5 * full, rel=0.05)
    assert filled((7.0, 1.0, 1.0, 1.0)) == full
