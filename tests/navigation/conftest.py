"""Fixtures that build what a camera would show of a simple world."""

from math import cos, sin

import numpy as np
import pytest

from navigation.landmark import sighting
from navigation.observation import CameraView, Frame, Observation

HEIGHT = 0.47


def _view(pan=0.0, tilt=-0.44, hfov=1.5, vfov=1.22):
    cp, sp, ct, st = cos(pan), sin(pan), cos(tilt), sin(tilt)
    forward = np.array([cp * ct, sp * ct, st])
    right = np.array([sp, -cp, 0.0])
    down = np.cross(forward, right)
    rotation = np.stack([right, down, forward], axis=1)
    return CameraView(rotation, np.array([0.0, 0.0, HEIGHT]), pan, tilt, hfov, vfov)


def _observe(
    pose,
    place,
    *,
    kind="obstacle",
    label="red",
    noise=(0.0, 0.0),
    sigma=(0.02, 0.01),
    radius=0.08,
    radius_sigma=0.01,
    cut=False,
    occluded=False,
):
    distance, bearing = sighting(pose, place)
    return Observation(
        kind=kind,
        label=label,
        distance=distance + noise[0],
        bearing=bearing + noise[1],
        covariance=np.diag([sigma[0] ** 2, sigma[1] ** 2]),
        radius=radius,
        radius_sigma=radius_sigma,
        cut=cut,
        occluded=occluded,
    )


def _frame(time, odometry, observations, camera=None, walking=True):
    return Frame(time, np.array(odometry, float), walking, camera or _view(), tuple(observations))


@pytest.fixture(scope="session")
def view():
    """Builds a `CameraView` from pan and tilt."""
    return _view


@pytest.fixture(scope="session")
def observe():
    """Builds an `Observation` of a place in W from a pose."""
    return _observe


@pytest.fixture(scope="session")
def frame():
    """Builds a `Frame` from time, odometry and observations."""
    return _frame
