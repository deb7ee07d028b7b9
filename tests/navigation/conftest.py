"""Fixtures: camera frames, beliefs, tasks and scenes of simple worlds, and planners in them."""

from dataclasses import replace
from math import cos, sin

import numpy as np
import pytest

from navigation.baselines.choice import build_planner
from navigation.belief.belief import Belief, Motion, Particles, Track
from navigation.belief.tracks import Tracks
from navigation.decision import SpeedLimits, Task
from navigation.motion.move_to_goal import move_to_goal
from navigation.motion.planning_scene import PlanningScene
from navigation.observation import CameraModel, CameraView, Frame
from navigation.parameters.navigation import NavigationParameters
from navigation.scene import Scene, extended_radius
from tests.navigation.sightings import range_bearing
from vision.detection import Detection

HEIGHT = 0.47
FOOTSTEP = 0.34
LIMITS = SpeedLimits(0.20, 0.10, 0.08, 0.8, 0.3, FOOTSTEP)


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


def _advance(pose, body, time=FOOTSTEP):
    middle = pose[2] + 0.5 * time * body[2]
    return pose + time * np.array([*(_rotation(middle) @ body[:2]), body[2]])


@pytest.fixture(scope="session")
def advance():
    """Moves a pose by a body velocity for one footstep."""
    return _advance


@pytest.fixture(scope="session")
def limits():
    """Speed limits of the walking layer."""
    return LIMITS


def _parameters(method="univector", **constants):
    """Profile of a method; `constants` replace those of the method."""
    base = NavigationParameters.paper() if method == "paper" else NavigationParameters()
    if method == "univector":
        return replace(base, univector=replace(base.univector, **constants))
    name = method.replace("-", "_")
    changed = {name: replace(getattr(base.planner, name), **constants)}
    return replace(base, planner=replace(base.planner, method=method, **changed))


@pytest.fixture(scope="session")
def parameters():
    """Builds the parameters of a method, with constants of that method."""
    return _parameters


class _Samples:
    """Generator that draws the same samples at every call."""

    def standard_normal(self, shape):
        return np.random.default_rng(0).standard_normal(shape)


def _planner(method="univector", *, rng=None, parameters=None, **constants):
    p = parameters or _parameters(method, **constants)
    return build_planner(p, LIMITS, rng or _Samples())


@pytest.fixture(scope="session")
def planner():
    """Builds the planner of a method; without a generator it draws the same samples always."""
    return _planner


def _scene(belief=None, task=None, parameters=None, body=(0.0, 0.0, 0.0), **details):
    return Scene.of(
        _belief() if belief is None else belief,
        _task() if task is None else task,
        parameters or NavigationParameters(),
        body=np.array(body, float),
        **details,
    )


@pytest.fixture(scope="session")
def scene():
    """Builds a `Scene` from belief and task."""
    return _scene


@pytest.fixture(scope="session")
def plan():
    """Returns the first decision of a method at belief and task."""

    def plan(method, belief, task, *, memory=None, look=None, **constants):
        p, planned = _parameters(method, **constants), _planner(method, **constants)
        memory = planned.begin() if memory is None else memory
        decision, _ = planned.plan(memory, _scene(belief, task, p, np.zeros(3), look=look))
        return decision

    return plan


def _planning(tracks=(), task=None, pose=(0.0, 0.0, 0.0), body=(0.0, 0.0, 0.0), **details):
    p = details.pop("parameters", None) or NavigationParameters()
    obstacles, task, pose = Tracks.of(tracks), task or _task(), np.array(pose, float)
    psi = np.array(details.pop("psi", np.zeros(len(obstacles))), float)
    course = move_to_goal(pose[:2], task.target, task.heading, p.univector)
    settings = {
        "course": float(course),
        "speed": LIMITS.vx,
        "facing": None,
        "side": 0,
        "limits": LIMITS,
        **details,
    }
    return PlanningScene(
        pose=pose,
        body=np.array(body, float),
        obstacles=obstacles,
        psi=psi,
        s_oe=extended_radius(obstacles, 0.0, psi, p.univector),
        task=task,
        parameters=p,
        **settings,
    )


@pytest.fixture(scope="session")
def planning():
    """Builds the `PlanningScene` of a method from tracks and a task."""
    return _planning


class _Walker:
    """Closed loop of a planner and a body with acceleration limits."""

    def __init__(self, planner, parameters, pose):
        self.pose, self.body, self.memory = np.array(pose, float), np.zeros(3), planner.begin()
        self.command = np.zeros(3)
        self._planner, self._parameters = planner, parameters
        self._change = FOOTSTEP * np.array([LIMITS.acceleration] * 2 + [2.0])

    def step(self, task, tracks=(), landmarks=None):
        near = None if landmarks is None else landmarks.near(self.pose[:2])
        here = _scene(
            _belief(tracks, self.pose), task, self._parameters, self.command, landmarks=near
        )
        decision, self.memory = self._planner.plan(self.memory, here)
        self.command = decision.velocity
        self.body += np.clip(self.command - self.body, -self._change, self._change)
        self.pose = _advance(self.pose, self.body)
        return decision

    def distance(self, point):
        return float(np.hypot(*(self.pose[:2] - point)))

    def arrive(self, mission, footsteps=90, **world):
        """Walk until the mission is done; return its last task."""
        for _ in range(footsteps):
            task = mission.update(self.pose)
            if task.done:
                break
            self.step(task, **world)
        return task

    def pass_by(self, obstacle, task, **world):
        """Walk to the target of `task`; return the minimum distance to `obstacle`, 0 if late."""
        least = 9.0
        for _ in range(90):
            self.step(task, **world)
            least = min(least, self.distance(obstacle))
            if self.distance(task.target) < 0.15:
                return least
        return 0.0


@pytest.fixture(scope="session")
def walker():
    """Builds a closed loop of a method from a pose; the samples of `mppi` follow seed 0."""

    def walker(method="univector", pose=(0.0, 0.0, 0.0), parameters=None, **constants):
        p = parameters or _parameters(method, **constants)
        return _Walker(_planner(method, rng=np.random.default_rng(0), parameters=p), p, pose)

    return walker
