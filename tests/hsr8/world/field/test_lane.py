import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.scenario.world import LineMover
from hsr8.world.field.lane import Lane, apart_at_all_times, distance, motion_law
from hsr8.world.field.layout import Obstacle
from hsr8.world.field.motion import Circle, Line, Shuttle

LAWS = (
    Shuttle((0.0, 0.0), (1.0, 0.5), 0.1, 1.0),
    Circle((0.2, -0.3), 0.8, 0.1),
    Circle((0.2, -0.3), 0.8, -0.1, 1.0),
    Line((1.0, 1.0), (0.01, -0.02)),
)
points = st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3)), min_size=1, max_size=6)


def lane_of(motion):
    return Lane.of(Obstacle(motion.position(0.0), 0.1, 0.3, "red", motion))


@pytest.mark.parametrize("motion", LAWS, ids=lambda motion: type(motion).__name__)
@given(time=st.floats(0.0, 60.0))
def test_a_mover_is_always_on_its_lane(motion, time):
    lane = lane_of(motion)
    spacing = np.hypot(*np.diff(lane.path, axis=0).T).max()
    assert distance(np.array([motion.position(time)]), lane.path)[0] <= 0.5 * spacing + 1e-9
    assert lane.obstacle.position == motion.position(0.0)
    assert distance(lane.ends, lane.path).max() < 1e-12


@given(first=points, second=points)
def test_the_nearest_is_the_nearest(first, second):
    distances = distance(np.array(first), second)
    expected = [min(np.hypot(x - u, y - w) for u, w in second) for x, y in first]
    assert np.allclose(distances, expected)


def test_a_heading_of_a_right_angle_is_one():
    motion = motion_law(
        LineMover(motion="line", color="red", radius=0.1, start=(0, 0), heading_deg=90, speed=0.1)
    )
    assert motion.velocity(0.0) == (0.0, 0.1)


def test_movers_that_never_meet_may_cross_lanes():
    first = lane_of(Line((-1.0, 0.0), (0.1, 0.0)))
    meets = lane_of(Line((0.0, -1.0), (0.0, 0.1)))
    later = lane_of(Line((0.0, -2.0), (0.0, 0.1)))
    assert not apart_at_all_times(first, meets, 0.2)
    assert apart_at_all_times(first, later, 0.2)
    assert apart_at_all_times(later, first, 0.2)
