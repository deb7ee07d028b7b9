from math import pi

import numpy as np
import pytest

from navigation.gaze.grid import GazeGrid
from navigation.parameters.gaze import GazeParameters


@pytest.mark.parametrize("step", np.linspace(0.03, 0.5, 24))
def test_the_cells_fill_the_limits_of_the_head(step):
    g = GazeGrid.of(GazeParameters(step=step))
    assert pi / 2 - step < g.pan[-1] <= pi / 2 + 1e-9
    assert g.pan[0] == -g.pan[-1]
    assert g.tilt[0] == -pi / 3
    assert pi / 9 - step < g.tilt[-1] <= pi / 9 + 1e-9


def test_a_fixed_camera_has_one_tilt():
    g = GazeGrid.of(GazeParameters(moved_by="body", fixed_tilt=-0.3))
    assert g.tilt.tolist() == [-0.3]
