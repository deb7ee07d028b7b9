"""Fixtures: camera frames, beliefs and tasks of simple worlds."""

from math import cos, sin

import numpy as np
import pytest

from navigation.belief.belief import Belief, Motion, Particles, Track
from navigation.decision import SpeedLimits, Task
from navigation.observation import CameraModel, CameraView, Frame
from tests.navigation.sightings import range_bearing
from vision.detection import Detection

HEIGHT = 0.47


def _view(pan=0.0, tilt=-0.44, hfov=1.5, vfov=1.22):
    cp, sp, ct, st = cos(pan), sin(pan), cos(tilt), sin(tilt)
    forward = np.array([cp * ct, sp * ct, st])
    right = np.array([sp, -cp, 0.0])
    down = np.cross(forward, right)
    rotation = np.stack([right, down, forward], axis=1)
    return CameraView(rotation, np.array([0.0, 0.0, HEIGHT]), pan, tilt, CameraModel(hfov, vfov))


def _observe(
    pose,
    point,
    *,
    kind="obstacle",
    label="red",
    noise=(0.0, 0.0),
    sigma=(0.02, 0.01),
    radius=0.08,
    radius_sigma=0.01,
    cut=False,
    occluded=False,
    by_radius=(0.0, 0.0),
):
    distance, bearing = range_bearing(pose, point)
    return Detection(
        kind=kind,
        label=label,
        distance=distance + noise[0],
        bearing=bearing + noise[1],
        covariance=np.diag([sigma[0] ** 2, sigma[1] ** 2]),
        radius=radius,
        radius_sigma=radius_sigma,
        cut=cut,
        occluded=occluded,
        by_radius=np.array(by_radius),
        box=(0, 0, 0, 0),
    )


def _frame(time, odometry, observations, camera=None):
    motion = np.diag([4e-6, 4e-6, 1e-6])
    return Frame(time, np.array(odometry, float), motion, camera or _view(), tuple(observations))


@pytest.fixture(scope="session")
def view():
    """Builds a `CameraView` from pan and tilt."""
    return _view


@pytest.fixture(scope="session")
def observe():
    """Builds the detection of a point in W from a pose."""
    return _observe


@pytest.fixture(scope="session")
def frame():
    """Builds a `Frame` from time, odometry and observations."""
    return _frame


class _Map:
    """A local map that answers with given functions of points in W."""

    cell, origin = 0.1, (-3.0, -3.0)

    def __init__(self, confidence, age):
        self._confidence, self._age = confidence, age

    @property
    def age(self):
        centres = -2.95 + 0.1 * np.arange(60)
        return np.array([[self._age(x, y) for x in centres] for y in centres])

    def confidence_at(self, points):
        return np.array([self._confidence(*p) for p in np.asarray(points).tolist()])

    def age_at(self, points):
        return np.array([self._age(*p) for p in np.asarray(points).tolist()])


def _track(point, velocity=(0.0, 0.0), motion=None, *, id=1, sigma=0.01, age=0.0, **details):
    moving = Motion.MOVING if np.hypot(*velocity) > 0 else Motion.STATIC
    cloud = details.pop("particles", None)
    if cloud is not None:
        places, velocities, weights = (np.array(a, float) for a in cloud)
        rates = np.array(details.pop("turn_rates", np.zeros(len(weights))), float)
        cloud = Particles(places, velocities, rates, weights)
    return Track(
        id=id,
        label="red",
        position=np.array(point, float),
        velocity=np.array(velocity, float),
        covariance=np.diag([sigma**2, sigma**2, 0.01**2, 0.01**2]),
        radius=details.pop("radius", 0.08),
        radius_sigma=details.pop("radius_sigma", 0.005),
        motion=motion or moving,
        hits=details.pop("hits", 20),
        age=age,
        last_seen=np.array(point, float),
        visible=age == 0.0,
        particles=cloud,
        reach=details.pop("reach", 0.0),
        turn_rate=details.pop("turn_rate", 0.0),
    )


def _belief(tracks=(), pose=(0.0, 0.0, 0.0), *, time=0.0, sigma=0.005, **details):
    return Belief(
        time=time,
        pose=np.array(pose, float),
        pose_covariance=np.diag([sigma**2, sigma**2, details.pop("turn_sigma", 0.005) ** 2]),
        tracks=tuple(tracks),
        local_map=_Map(
            details.pop("confidence", lambda x, y: 1.0), details.pop("age", lambda x, y: 0.0)
        ),
        view=details.pop("camera", None) or _view(),
        seen_beacons=(),
        lost=details.pop("lost", False),
        filter_faults=0,
    )


def _task(target=(2.0, 0.0), heading=0.0, *, is_goal=False, aligning=False, done=False):
    return Task(np.array(target, float), heading, is_goal, 0, aligning, done)


@pytest.fixture(scope="session")
def track():
    """Builds a `Track` from a position, a velocity and a classification."""
    return _track


@pytest.fixture(scope="session")
def belief():
    """Builds a `Belief` from tracks and a pose; the local map is fresh by default."""
    return _belief


@pytest.fixture(scope="session")
def task():
    """Builds a `Task`."""
    return _task


def _tracks(places, velocities):
    return [_track(x, v, id=i) for i, (x, v) in enumerate(zip(places, velocities, strict=True))]


@pytest.fixture(scope="session")
def tracks():
    """Builds a list of tracks from positions and velocities."""
    return _tracks


def _rotation(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


@pytest.fixture(scope="session")
def rotation():
    """Builds a rotation matrix from an angle."""
    return _rotation


def _advance(pose, body, time=0.34):
    middle = pose[2] + 0.5 * time * body[2]
    return pose + time * np.array([*(_rotation(middle) @ body[:2]), body[2]])


@pytest.fixture(scope="session")
def advance():
    """Moves a pose by a body velocity for one footstep."""
    return _advance


@pytest.fixture(scope="session")
def limits():
    """Speed limits of the walking layer."""
    return SpeedLimits(0.20, 0.10, 0.08, 0.8, 0.3, 0.34)
