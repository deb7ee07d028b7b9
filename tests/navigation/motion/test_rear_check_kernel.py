"""Compiled against plain Python bit for bit, and against formulas over whole arrays."""

import numpy as np
import pytest

from navigation.angles import wrap_array
from navigation.motion import rear_check_kernel as kernel

POSE = np.array([0.4, -1.2, 2.9])
COURSE, SPEED = 2.6, 0.15
THREAT = (0.22, 0.12, 0.1, 0.4, 8.0, 2.0)
BODY = (3.0, 0.08, 1.2)
RINGS = np.array([0.4, 0.7, 1.2])
RAYS = np.array([2.2, 2.4, 2.6, -2.2, -2.4, -2.6])
SECTORS = np.array([[2.4, 0.2], [-2.4, 0.2], [3.0, 0.3]])


@pytest.fixture
def cloud():
    rng = np.random.default_rng(1)
    weights = rng.uniform(0.1, 1.0, 300)
    return POSE[:2] + rng.uniform(-1.4, 1.4, (300, 2)), weights / weights.sum()


@pytest.fixture
def age():
    return np.append(np.random.default_rng(2).uniform(0.0, 12.0, 17), np.inf)


def urgency(age, gap, bearing):
    assumed, _, min_approach, min_time, max_age, max_urgency = THREAT
    approach = np.maximum(min_approach, assumed + SPEED * np.cos(bearing))
    contact = np.maximum(min_time, gap / approach)
    return np.minimum(max_urgency, np.minimum(max_age, age) / contact)


def test_compiled_and_plain_agree(age, cloud):
    for function, arguments in (
        (kernel.ray_points, (POSE, COURSE, RINGS, RAYS)),
        (kernel.ground_urgency, (age, RINGS, RAYS, SPEED, THREAT, 2)),
        (kernel.cloud_urgency, (*cloud, BODY, POSE, COURSE, SECTORS, SPEED, THREAT)),
    ):
        result, plain = function(*arguments), function.py_func(*arguments)
        assert np.abs(result - plain).max() <= 1e-14


def test_points_lie_on_the_rays(age):
    offset = kernel.ray_points(POSE, COURSE, RINGS, RAYS) - POSE[:2]
    assert np.allclose(np.hypot(*offset.T), np.tile(RINGS, len(RAYS)))
    bearing = np.arctan2(offset[:, 1], offset[:, 0]) - COURSE
    assert np.allclose(wrap_array(bearing - np.repeat(RAYS, len(RINGS))), 0.0)


def test_ground_agrees_with_the_formula_over_arrays(age):
    each = urgency(age.reshape(6, 3), RINGS - 2.0 * THREAT[1], RAYS[:, None])
    result = kernel.ground_urgency(age, RINGS, RAYS, SPEED, THREAT, 2)
    assert result == pytest.approx([each[:3].mean(), each[3:].mean()])
    assert each.max() == THREAT[-1] > result.max()


def test_a_cloud_agrees_with_the_formula_over_arrays(cloud):
    positions, weights = cloud
    offset = positions - POSE[:2]
    distance, bearing = np.hypot(*offset.T), np.arctan2(offset[:, 1], offset[:, 0]) - COURSE
    inside = np.abs(wrap_array(bearing - SECTORS[:, :1])) <= SECTORS[:, 1:]
    each = urgency(BODY[0], distance - BODY[1] - THREAT[1], bearing)
    wanted = (inside & (distance <= BODY[2])) @ (weights * each)
    result = kernel.cloud_urgency(*cloud, BODY, POSE, COURSE, SECTORS, SPEED, THREAT)
    assert result == pytest.approx(wanted)
    assert (result > 0.0).all()
