from types import SimpleNamespace

import numpy as np
import pytest

from hsr8.render.walking_table import walking_of
from hsr8.scenario.loader import load_scenario
from hsr8.world.truth.truth import ActivePush
from walking.body.joints import JOINT_NAMES

TRUE = (1.0, -0.5, 0.7)


@pytest.fixture(scope="module")
def table(fake, tables_of):
    """Walking of three records: drifted odometry, an airborne robot, a push."""
    push = ActivePush(
        0, 0.03, 0.05, "torso_link", 0.0, np.array([1.0, 2.0, 0.3]), np.array([3.0, 4.0, 0.0])
    )
    torque = np.arange(26.0)
    records = [
        fake.record(0.0, (0.2, 0.1, -0.4), robot=np.array(TRUE), joint_torque=torque),
        fake.record(0.02, TRUE, foot_force=np.zeros(2)),
        fake.record(0.04, TRUE, pushes=(push,)),
    ]
    run = SimpleNamespace(
        scenario=lambda: load_scenario("walk"), records=tables_of(records)["records"]
    )
    return walking_of(run)


def test_points_in_odometry_are_at_the_true_robot(table):
    for name in ("zmp", "com", "dcm"):
        assert table.points(name) == pytest.approx(np.array([TRUE[:2]] * 3))
    assert table["left_yaw"] == pytest.approx(TRUE[2])
    middle = 0.5 * (table.points("left") + table.points("right"))
    assert middle == pytest.approx(table.points("zmp"))


def test_an_airborne_robot_has_no_centre_of_pressure(table):
    assert np.isnan(table["cop_x"]).tolist() == [False, True, False]


def test_a_push_is_in_the_rows_in_which_it_acts(table):
    assert table["push_fy"].tolist() == [0.0, 0.0, 4.0]
    assert table["push_y"].tolist() == [0.0, 0.0, 2.0]
    assert table["push_impulse"] == pytest.approx([0.0, 0.0, 0.25])


def test_torques_are_those_of_the_legs(table):
    assert [table[f"torque_{name}"][0] for name in JOINT_NAMES[:12]] == list(range(12))
    assert list(table.torque_limit) == list(JOINT_NAMES[:12])


def test_a_window_has_the_rows_between_two_times(table):
    part = table.window(0.02, 0.04)
    assert part.time.tolist() == [0.02, 0.04]
    assert part["push_fy"].tolist() == [0.0, 4.0]
