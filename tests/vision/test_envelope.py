import numpy as np
import pytest

from tests.vision.scene import at, pose, traced
from vision.envelope import PIECE, add_pieces, borders, envelopes
from vision.view import angles

OBSTACLES = [
    at(0.9, 4.0, "red", 0.09),
    at(1.6, 0.0, "green", 0.10),
    at(1.1, -30.0, "blue", 0.12),
    at(2.4, 18.0, "red", 0.05),
]


def test_envelopes_bound_the_directions_of_all_pixels():
    """Lowest and highest slope of a blob near each azimuth, from the middles of its pixels."""
    image = traced(OBSTACLES, pose(pan=0.1, tilt=-0.3, roll=0.05))
    view = image.view[0]
    for blob in image.blobs:
        (start, width, size), (low, high), _ = envelopes(blob, image.runs, image.padded, view)
        middles = [
            (column + 0.5, row + 0.5)
            for row, first, last, _ in image.runs[blob.first_run : blob.last_run].tolist()
            for column in range(first, last)
        ]
        for u, v in middles:
            azimuth, slope = angles(view, u, v)
            column = int((azimuth - start) / width)
            near = slice(max(column - 1, 0), column + 2)
            assert low[near].min() - size < slope < high[near].max() + size


def test_a_piece_has_the_ends_and_the_distance_of_its_object():
    """Two objects: the nearer one, on the left, occludes an end of the farther one."""
    envelope, usable = np.repeat([-0.3, -0.6], [6, 8]), np.ones(14, bool)
    pieces, points = np.zeros(9, PIECE), (np.empty(20), np.empty(20), np.ones(20, np.uint8))
    count, used = add_pieces(
        pieces, points, 3, envelope, usable, (0.1, 0.01, 0.0), 0.1, -0.6, True, (True, True)
    )
    assert (count, used) == (2, 15)
    far, near = pieces[:2]
    ends = [(p.right, p.left, p.right_true, p.left_true, p.run) for p in (far, near)]
    assert ends[0] == pytest.approx((0.1, 0.16, True, False, 2.0))
    assert ends[1] == pytest.approx((0.16, 0.24, True, True, 1.0))
    assert [(p.first, p.last) for p in (far, near)] == [(3, 8), (8, 15)]
    inner = np.r_[0:5, 7:14]
    azimuth, slope, outer = (values[3:15] for values in points)
    assert azimuth == pytest.approx(0.1 + 0.01 * (inner + 0.5))
    assert np.array_equal(slope, envelope[inner])
    assert not outer.any()


def test_an_envelope_is_cut_at_its_steps_and_nowhere_else():
    envelope = np.repeat([-0.5, -0.3, -0.6], [5, 1, 6])
    assert borders(envelope, 0.1).tolist() == [0, 6, 12]  # one column is too narrow
    assert borders(envelope, 1.0).tolist() == [0, 12]
