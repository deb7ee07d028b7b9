"""Properties of both bodies."""

import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.body.physics import PhysicsBody
from hsr8.world.field.layout import Obstacle

pytestmark = pytest.mark.parametrize("kind", [KinematicBody, PhysicsBody])


def body_in(kind, world, noise, *obstacles, seed=0, **details):
    layout, model = world(*obstacles, **details)
    return kind(model, load_robot("hsr8"), layout, noise, np.random.default_rng(seed))


def test_it_starts_at_the_pose_of_the_layout(world, silent, kind):
    truth = body_in(kind, world, silent, start=(0.7, -0.4, 2.0)).truth()
    assert np.allclose(truth.robot, (0.7, -0.4, 2.0), atol=1e-6)


def test_clearance_is_the_gap_to_the_body(world, silent, kind):
    near, far = (
        body_in(kind, world, silent, Obstacle((0.0, y), 0.10, 0.3, "green")).truth().clearance
        for y in (0.40, 0.45)
    )
    assert 0.1 < near < 0.3
    assert np.isclose(far - near, 0.05, atol=1e-3)
    assert body_in(kind, world, silent, beacons=()).truth().clearance == np.inf
