import numpy as np

from tests.vision.scene import at, pose, traced
from vision.envelope import MAX_CELLS, add_envelopes, borders
from vision.tables import OUTSIDE
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
    points = np.empty(2 * MAX_CELLS), np.empty(2 * MAX_CELLS), np.empty(2 * MAX_CELLS, np.uint8)
    for blob in image.blobs:
        n, width, pixel = add_envelopes(points, 0, blob, image.runs, image.padded, image.view[0])
        azimuth, (low, high) = points[0][:n], points[1][: 2 * n].reshape(2, n)
        assert np.allclose(np.diff(azimuth), width)
        assert np.array_equal(points[0][n : 2 * n], azimuth)
        middles = [
            (column + 0.5, row + 0.5)
            for row, first, last, _ in image.runs[blob.first_run : blob.last_run].tolist()
            for column in range(first, last)
        ]
        for u, v in middles:
            direction, slope = angles(image.view[0], u, v)
            column = round((direction - azimuth[0]) / width)
            near = slice(max(column - 1, 0), column + 2)
            assert low[near].min() - pixel < slope < high[near].max() + pixel


def test_an_envelope_next_to_another_object_is_no_edge_of_a_foot():
    """The nearer red obstacle hides the middle of the foot of the green one."""
    image = traced(OBSTACLES[:2], pose(tilt=-0.3))
    points = np.empty(2 * MAX_CELLS), np.empty(2 * MAX_CELLS), np.empty(2 * MAX_CELLS, np.uint8)
    blob = image.named("green")
    n, _, _ = add_envelopes(points, 0, blob, image.runs, image.padded, image.view[0])
    foot, head = points[2][: 2 * n].reshape(2, n)
    assert set(foot.tolist()) == {0, OUTSIDE}
    assert not head.any()


def test_an_envelope_is_cut_at_its_steps_and_nowhere_else():
    envelope = np.repeat([-0.5, -0.3, -0.6], [5, 1, 6])
    assert borders(envelope, 0.1, 0.0).tolist() == [0, 6, 12]  # one column is too narrow
    assert borders(envelope, 1.0, 0.0).tolist() == [0, 12]
    assert borders(envelope, 0.1, 1.9).tolist() == [0, 12]  # the distance hardly changes
