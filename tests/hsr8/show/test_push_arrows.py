import numpy as np
import pytest

from hsr8.show.push_arrows import GAP, SHOWN, push_arrows
from hsr8.world.body.pushes import ActivePush


@pytest.fixture
def pushes(fake, tables_of):
    """Arrows of two pushes that follow at once, the robot being 1 m along x."""
    pose, point = (1.0, 0.0, 0.0), np.array([1.0, 0.0, 0.3])
    first = ActivePush(0, 0.19, 0.05, "torso_link", 0.0, point, np.array([10.0, 0.0, 0.0]))
    second = ActivePush(1, 0.245, 0.04, "torso_link", 0.0, point, np.array([0.0, -5.0, 0.0]))
    records = [fake.record(0.2, pose, pushes=(first,)), fake.record(0.26, pose, pushes=(second,))]
    return push_arrows(tables_of(records)["records"])


def test_arrows_end_before_the_point_of_the_force(pushes):
    first, second = pushes
    assert (first.begin, second.begin) == pytest.approx((0.19, 0.245))
    assert (first.impulse, second.impulse) == pytest.approx((0.5, 0.2))
    assert first.tip[:2] == pytest.approx([-GAP, 0.0])
    assert second.tip[:2] == pytest.approx([0.0, GAP])


def test_an_arrow_moves_with_the_robot_and_disappears(pushes):
    first, base = pushes[0], np.array([1.5, 0.2, 0.0])
    tail, tip = first.at(base)
    assert tip == pytest.approx(base + first.tip)
    assert tip - tail == pytest.approx([0.2, 0.0, 0.0])
    times = (0.17, 0.19, 0.3, 0.195 + SHOWN)
    assert [first.shown(time, 1.0) for time in times] == [False, True, True, False]
    assert first.shown(0.19 + SHOWN, 2.0)
