"""Properties of both bodies."""

import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.scenario.sensors import SensorNoise
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.body.physics import PhysicsBody
from hsr8.world.field.layout import Obstacle, standard_beacons
from walking.signals import JointTargets

pytestmark = pytest.mark.parametrize("kind", [KinematicBody, PhysicsBody])


def body_in(kind, world, noise, *obstacles, seed=0, **details):
    layout, model = world(*obstacles, **details)
    return kind(model, load_robot("hsr8"), layout, noise, np.random.default_rng(seed))


def hold(body):
    position = body.sense().joint_position
    return JointTargets(position, position)


def test_it_starts_at_the_pose_of_the_layout(world, silent, kind):
    truth = body_in(kind, world, silent, start=(0.7, -0.4, 2.0)).truth()
    assert np.allclose(truth.robot, (0.7, -0.4, 2.0), atol=1e-6)


def test_the_seed_determines_the_run(world, kind):
    def readings(seed):
        body = body_in(kind, world, SensorNoise(), seed=seed)
        states = []
        for _ in range(20):
            body.apply(hold(body))
            states.append(body.state_bytes())
        return states

    assert readings(1) == readings(1)
    assert readings(1) != readings(2)


def test_contact_with_a_beacon_is_reported(world, silent, kind):
    beacon = standard_beacons((5.0, 5.0))[0]
    x, y = beacon.position
    body = body_in(kind, world, silent, start=(x - 0.11, y, 0.0))
    targets, contacts = hold(body), []
    for _ in range(80):
        body.apply(targets)
        contacts += body.truth().contacts
    assert {(c.obstacle, c.name) for c in contacts} == {(0, f"beacon {beacon.name}")}
    assert body.truth().clearance < 0.005


def test_clearance_is_the_gap_to_the_body(world, silent, kind):
    near, far = (
        body_in(kind, world, silent, Obstacle((0.0, y), 0.10, 0.3, "green")).truth().clearance
        for y in (0.40, 0.45)
    )
    assert 0.1 < near < 0.3
    assert np.isclose(far - near, 0.05, atol=1e-3)
    assert body_in(kind, world, silent, beacons=()).truth().clearance == np.inf
