from math import atan, radians

import numpy as np
import pytest

from hsr8.show.log.camera import image_points, map_points
from navigation.gaze.grid import GazeGrid
from navigation.parameters.gaze import GazeParameters
from vision.camera import PinholeCamera

CAMERA = PinholeCamera(320, 240, 160.0)


@pytest.mark.parametrize("head", [(0.0, 0.0), (0.9, -0.6), (-1.2, 0.3)])
def test_the_direction_of_the_head_is_the_centre_of_the_image(head):
    assert image_points(head, np.array([head]), CAMERA)[0] == pytest.approx([160.0, 120.0])


def test_left_and_up_are_left_and_up_in_the_image():
    angles = np.array([[atan(0.5), 0.0], [0.0, atan(0.5)]])
    left, up = image_points((0.0, 0.0), angles, CAMERA)
    assert left == pytest.approx([80.0, 120.0])
    assert up == pytest.approx([160.0, 40.0])


def test_directions_beyond_the_image_are_on_its_border():
    aside, above = image_points((0.0, -0.3), np.radians([[-85.0, 0.0], [0.0, 60.0]]), CAMERA)
    assert aside[0] == 320.0
    assert above[1] == 0.0


def test_directions_behind_the_camera_are_not_drawn():
    assert image_points((0.0, 0.0), np.array([[radians(170.0), 0.0]]), CAMERA) is None


@pytest.mark.parametrize(
    "gaze",
    [
        GazeParameters(),
        GazeParameters(max_pan=1.0, min_tilt=-0.8, max_tilt=0.11, step=0.13),
        GazeParameters(moved_by="body"),
    ],
)
def test_pixels_of_the_gaze_map_match_its_cells(gaze):
    grid = GazeGrid.of(gaze)
    rows, columns = len(grid.tilt), len(grid.pan)
    pan, tilt = np.meshgrid(grid.pan, grid.tilt)
    cells = np.column_stack([pan.ravel(), tilt.ravel()])
    # The image shows left on its left and up above.
    v, u = np.mgrid[rows - 0.5 : 0.0 : -1.0, columns - 0.5 : 0.0 : -1.0]
    pixels = map_points(cells, grid)
    assert pixels == pytest.approx(np.column_stack([u.ravel(), v.ravel()]))


def test_directions_beyond_the_gaze_map_are_on_its_border():
    gaze = GazeParameters()
    beyond = np.array([[gaze.max_pan + 1.0, gaze.max_tilt + 1.0], [-3.0, -3.0]])
    assert map_points(beyond, GazeGrid.of(gaze)).tolist() == [[0.0, 0.0], [19.0, 9.0]]
