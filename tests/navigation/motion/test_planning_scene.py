from math import pi

import numpy as np
import pytest

from navigation.motion.planning_scene import Desired


def test_the_predicted_scene_is_a_footstep_later(planning, track):
    s = planning([track((1.0, 0.0), (0.0, 0.1))], pose=(0, 0, pi / 2), body=(0.1, 0.0, 0.2))
    later = s.predicted()
    assert later.pose == pytest.approx([0.0, 0.034, pi / 2 + 0.068])
    assert later.obstacles.position[0] == pytest.approx([1.0, 0.034])
    assert later.body == pytest.approx(s.body)
    assert s.obstacles.position[0] == pytest.approx([1.0, 0.0])


def test_walking_turns_to_the_motion_or_to_the_target_heading(planning, limits):
    s = planning()
    assert s.walk(pi / 2, 0.1) == pytest.approx([0.0, limits.vy, limits.wz])
    assert s.walk(0.0, 0.0) == pytest.approx(0.0)
    assert planning(facing=0.2).walk(0.0, 0.1) == pytest.approx([0.1, 0.0, 0.3])


def test_radii_contain_both_bodies_the_margin_and_the_uncertainty_of_movers(planning, track):
    s = planning([
        track((1, 0), sigma=0.5),
        track((1, 1), (0.1, 0.0), sigma=0.03),
        track((1, 1), (0.1, 0.0), sigma=0.5),
    ])  # fmt: skip
    most = s.parameters.planner.max_sigma
    assert s.touching == pytest.approx(s.parameters.univector.s_robot + 0.08)
    assert s.radii(0.02) - s.touching == pytest.approx([0.02, 0.05, 0.02 + most])


def test_repulsion_yields_to_a_destination_nearer_than_the_obstacle(planning, task):
    near = planning(task=task((0.3, 0.0)))
    assert near.yielding(np.array([0.1, 0.3, 0.6])) == pytest.approx([1.0, 1.0, 0.5])


@pytest.mark.parametrize("pose", [(0.0, 0.0, 0.0), (1.0, -1.0, 2.0)])
def test_wanted_motion_towards_a_velocity_has_its_direction(planning, pose):
    s, radii = planning(pose=pose), np.zeros(0)
    assert Desired.towards(np.array([0.0, 0.1]), s, radii).direction == pytest.approx(pi / 2)
    assert Desired.towards(np.zeros(2), s, radii).direction == s.course
    assert np.hypot(*s.to_goal()) == pytest.approx(s.speed)
