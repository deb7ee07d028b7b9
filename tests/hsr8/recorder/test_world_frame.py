import numpy as np
import pytest

from hsr8.recorder.world_frame import WorldFrame

TRUE = (1.0, -0.5, 0.7)


@pytest.fixture
def frame(fake, tables_of):
    """Frames of a robot that believes to be where it truly is, and of one that drifted."""
    drifted = fake.record(0.02, (0.2, 0.1, -0.4), robot=np.array(TRUE))
    return WorldFrame(tables_of([fake.record(0.0, TRUE), drifted])["records"])


def test_the_pose_in_odometry_becomes_the_true_pose(frame):
    points = np.array([TRUE[:2], (0.2, 0.1)])
    assert frame.point(points) == pytest.approx(np.array([TRUE[:2], TRUE[:2]]))
    assert frame.turn == pytest.approx([0.0, TRUE[2] + 0.4])


def test_distances_and_directions_turn_with_the_robot(frame):
    ahead = np.array([np.cos(-0.4), np.sin(-0.4)])
    begin, end = frame.point(np.array([[(0.0, 0.0), ahead]] * 2)).swapaxes(0, 1)
    assert (end - begin)[1] == pytest.approx([np.cos(TRUE[2]), np.sin(TRUE[2])])
    assert frame.vector(np.array([ahead, ahead])) == pytest.approx(end - begin)


def test_points_of_chosen_rows_are_transformed_with_these_rows(frame):
    rows = np.array([1, 0, 1])
    points = np.array([(0.2, 0.1), TRUE[:2], (0.2, 0.1)])
    assert frame.point(points, rows) == pytest.approx(np.array([TRUE[:2]] * 3))
