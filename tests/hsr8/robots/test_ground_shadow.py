"""The shadow of the arms on the floor, as the head camera sees it."""

from math import cos, pi, sin

import numpy as np
import pytest

from hsr8.robots.posed_shapes import BEARINGS, ground_shadow

HEIGHT = 0.5


def ball(bearing, away, z, radius):
    return np.array([[away * cos(bearing), away * sin(bearing), z]]), np.array([radius])


def hides(arm, point):
    """Whether a ball is in the way from the camera to a point of the floor."""
    (centre,), (radius,) = arm
    eye = np.array([0.0, 0.0, HEIGHT])
    ray = np.array([*point, 0.0]) - eye
    along = np.clip((centre - eye) @ ray / (ray @ ray), 0.0, 1.0)
    return np.linalg.norm(eye + along * ray - centre) < radius


@pytest.mark.parametrize("bearing", [-1.5, 0.3, 2.8])
@pytest.mark.parametrize("z", [0.38, 0.25, 0.1])
def test_what_a_ball_hides_is_within_its_shadow(bearing, z):
    """The converse does not hold: ground nearer than the shadow is visible below the arm."""
    arm = ball(bearing, 0.12, z, 0.04)
    shadow = ground_shadow([arm], HEIGHT)
    reach = shadow.max()
    steps = 2.0 * pi * np.arange(BEARINGS) / BEARINGS
    for reached, angle in zip(shadow, steps, strict=True):
        for distance in np.linspace(0.05, 3.0, 60):
            if hides(arm, (distance * cos(angle), distance * sin(angle))):
                assert reached > distance
    middle = round(bearing * BEARINGS / (2.0 * pi)) % BEARINGS
    assert shadow[middle] == reach
    assert hides(arm, (0.97 * reach * cos(bearing), 0.97 * reach * sin(bearing)))
    assert not hides(arm, (1.03 * reach * cos(bearing), 1.03 * reach * sin(bearing)))


def test_arms_above_the_camera_hide_no_floor_and_arms_at_its_height_all():
    assert not ground_shadow([ball(0.5, 0.2, 0.9, 0.05)], HEIGHT).any()
    assert ground_shadow([ball(0.5, 0.2, 0.5, 0.05)], HEIGHT).max() > 10.0


def test_the_shadow_turns_with_the_arms():
    plain = ground_shadow([ball(0.0, 0.12, 0.3, 0.04)], HEIGHT)
    quarter = ground_shadow([ball(0.5 * pi, 0.12, 0.3, 0.04)], HEIGHT)
    assert quarter == pytest.approx(np.roll(plain, BEARINGS // 4))
