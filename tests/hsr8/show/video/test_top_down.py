from dataclasses import replace

import numpy as np

from hsr8.recording import palette
from hsr8.show.video.top_down import TopDown


def test_frames_do_not_leave_traces_in_later_ones(layout, shown):
    above = TopDown(layout, (320, 300))
    movers = np.array([[1.0, 1.0]])
    first = above.draw(shown(), movers, np.zeros((0, 2)))
    above.draw(shown((1.0, 1.0, 1.0)), movers, np.array([[0.0, 0.0], [1.0, 1.0]]))
    assert np.array_equal(first, above.draw(shown(), movers, np.zeros((0, 2))))


def test_a_walk_without_waypoints_can_be_drawn(layout, shown):
    nowhere = replace(layout, waypoints=np.zeros((0, 2)))
    image = TopDown(nowhere, (64, 64)).draw(shown(), np.array([[1.0, 1.0]]), np.zeros((0, 2)))
    assert image.shape == (64, 64, 3)


def test_only_the_next_waypoints_are_shown(layout, shown):
    """The more of a course is passed, the less of it is drawn."""
    above = TopDown(layout, (300, 300))
    drawn = []
    for passed in (0, 1, 2):
        frame = shown(index=passed, target=np.array([0.0, 0.0]), tracks=())
        image = above.draw(frame, np.array([[1.0, 1.0]]), np.zeros((0, 2)))
        away = np.abs(image.astype(int) - palette.TARGET).sum(axis=-1)
        drawn.append(int((away < 90).sum()))
    assert drawn[0] > drawn[1] > drawn[2]
