from dataclasses import replace
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.robots.loaded import load_robot
from hsr8.scenario.sensors import Camera
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.camera.analytic import (
    DISTANCE,
    HIDDEN,
    MIN_DEPTH,
    AnalyticCamera,
    project,
    project_all,
)
from hsr8.world.camera.feed import CameraFaults
from hsr8.world.field.layout import Obstacle, Reactions
from hsr8.world.field.motion import Shuttle
from navigation.observation import CameraModel
from tests.vision.scene import CAMERA, pose
from vision.view import view_of
from walking.state import JointTargets

SIZE = {"width": CAMERA.width, "height": CAMERA.height, "vertical_fov_deg": 70.0}
AHEAD = Camera(source="analytic")
OPEN = np.zeros(1)


@pytest.fixture
def see(world, silent):
    """Detections over many frames of a robot that looks down a little."""

    def make(
        *obstacles,
        start=(0.0, 0.0, 0.0),
        frames=60,
        pan=0.0,
        tilt=-0.35,
        settings=AHEAD,
        shadow=OPEN,
    ):
        layout, model = world(*obstacles, start=start)
        body = KinematicBody(model, load_robot("hsr8"), layout, silent, np.random.default_rng(0))
        body.data.joint("head_pan").qpos[0] = pan
        body.data.joint("head_tilt").qpos[0] = tilt
        settings = settings.model_copy(update=SIZE)
        fov = {"analytic": CAMERA.horizontal_fov, "neck-reach": 4.2}.get(settings.source, 2.0 * pi)
        constants = CameraModel(fov, pi, shadow=shadow)
        rng = np.random.default_rng(1)
        camera = AnalyticCamera(layout, settings, constants, rng, CameraFaults())
        return [camera.capture(body) for _ in range(frames)]

    return make


def obstacles_in(frames):
    return [d for frame in frames for d in frame if d.kind == "obstacle"]


@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0), (1.0, -0.5, 2.2)])
@pytest.mark.parametrize("position", [(1.0, 0.0), (1.5, 0.6), (0.8, -0.3)])
def test_detections_are_unbiased_in_the_robot_frame(see, start, position):
    x, y, yaw = start
    c, s = np.cos(yaw), np.sin(yaw)
    there = (x + c * position[0] - s * position[1], y + s * position[0] + c * position[1])
    detections = obstacles_in(see(Obstacle(there, 0.08, 0.3, "red"), start=start, frames=200))
    assert len(detections) > 180
    errors = np.array(
        [
            (
                d.distance - np.hypot(*position),
                d.bearing - np.arctan2(position[1], position[0]),
                d.radius - 0.08,
            )
            for d in detections
        ]
    )
    sigma = errors.std(axis=0)
    assert np.all(np.abs(errors.mean(axis=0)) < 4 * sigma / np.sqrt(len(detections)) + 1e-6)


@pytest.mark.parametrize("hidden", [False, True])
def test_covariance_is_honest(see, hidden):
    """For whole obstacles and for partly hidden ones."""
    obstacles = [Obstacle((1.4, 0.18), 0.1, 0.3, "red")]
    obstacles += [Obstacle((0.8, 0.0), 0.1, 0.3, "green")] if hidden else []
    detections = [d for d in obstacles_in(see(*obstacles, frames=400)) if d.label == "red"]
    truth = np.array([np.hypot(1.4, 0.18), np.arctan2(0.18, 1.4)])
    nees = [
        (e := np.array([d.distance, d.bearing]) - truth) @ np.linalg.solve(d.covariance, e) / 2
        for d in detections
    ]
    assert {d.occluded for d in detections} == {hidden}
    assert 0.8 < np.mean(nees) < 1.2
    off = [(d.radius - 0.1) / d.radius_sigma for d in detections]
    assert 0.9 < np.std(off) < 1.1


def test_what_is_behind_another_or_behind_the_robot_is_not_seen(see):
    frames = see(
        Obstacle((0.8, 0.0), 0.12, 0.3, "red"),
        Obstacle((1.4, 0.0), 0.05, 0.3, "green"),
        Obstacle((-1.0, 0.0), 0.1, 0.3, "blue"),
    )
    assert {d.label for d in obstacles_in(frames)} == {"red"}


def test_a_thing_at_the_border_is_flagged(see):
    frames = see(Obstacle((0.6, 0.55), 0.12, 0.3, "red"))
    detections = obstacles_in(frames)
    assert detections
    assert all(d.cut for d in detections)


def test_far_things_are_not_reported(see):
    assert obstacles_in(see(Obstacle((4.4, 0.0), 0.1, 0.3, "red")))
    assert not obstacles_in(see(Obstacle((4.6, 0.0), 0.1, 0.3, "red")))


@pytest.mark.parametrize("bearing", np.radians([0.0, 100.0, -160.0, 180.0]))
def test_an_omnidirectional_camera_sees_in_every_direction_with_the_noise_of_any(see, bearing):
    position = (1.2 * np.cos(bearing), 1.2 * np.sin(bearing))
    obstacle = Obstacle(position, 0.08, 0.3, "red")
    frames = see(obstacle, frames=100, settings=Camera(source="omnidirectional"))
    detections = obstacles_in(frames)
    assert len(detections) > 85
    for d in detections:
        assert 0 <= d.box[0] < d.box[2] <= CAMERA.width
        assert 0 <= d.box[1] < d.box[3] <= CAMERA.height
        assert not d.cut
    off = [
        np.angle(np.exp(1j * (d.bearing - bearing))) / d.covariance[1, 1] ** 0.5 for d in detections
    ]
    assert 0.7 < np.std(off) < 1.4
    (ahead,) = {d.covariance[1, 1] for d in obstacles_in(see(Obstacle((1.2, 0), 0.08, 0.3, "red")))}
    assert detections[0].covariance[1, 1] == pytest.approx(ahead)


def test_a_camera_within_reach_of_the_neck_sees_to_both_sides_but_not_behind(see):
    def seen(degrees):
        bearing = np.radians(degrees)
        obstacle = Obstacle((1.2 * np.cos(bearing), 1.2 * np.sin(bearing)), 0.08, 0.3, "red")
        return bool(obstacles_in(see(obstacle, frames=5, settings=Camera(source="neck-reach"))))

    assert all(seen(angle) for angle in (0.0, 115.0, -115.0))
    assert not any(seen(angle) for angle in (125.0, -125.0, 180.0))


@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0), (1.0, -0.5, 2.2)])
def test_the_body_hides_the_foot_of_an_obstacle_but_not_its_top(see, start):
    """The shadow of the body counts only where the border of the image cuts the top off."""
    hidden = np.full(72, 0.7)

    def seen_at(distance):
        angle = start[2] + 1.2
        x, y = start[0] + distance * np.cos(angle), start[1] + distance * np.sin(angle)
        return Obstacle((float(x), float(y)), 0.08, 0.3, "red")

    near, far = seen_at(0.5), seen_at(0.85)
    assert obstacles_in(see(near, start=start, pan=1.2, tilt=-1.0))
    assert not obstacles_in(see(near, start=start, pan=1.2, tilt=-1.0, shadow=hidden))
    assert obstacles_in(see(near, start=start, pan=1.2, tilt=-0.35, shadow=hidden))
    assert obstacles_in(see(far, start=start, pan=1.2, tilt=-1.0, shadow=hidden))


RADIUS, HEIGHT = 0.08, 0.3
positions = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)).filter(
    lambda p: np.hypot(*p) > 0.2
)


@given(position=positions, pan=st.floats(-1.5, 1.5), tilt=st.floats(-0.6, 0.2))
def test_a_box_bounds_the_projected_edges_of_the_cylinder(position, pan, tilt):
    view = pose(pan, tilt)
    left, top, right, bottom, cut = project(
        *position, RADIUS, HEIGHT, False, view_of(CAMERA, view)[0], False
    )
    across = np.array([-position[1], position[0]]) * RADIUS / np.hypot(*position)
    points = np.array(
        [[*(position + s * across), z] for s in (-1, 1) for z in (0.0, 0.5 * HEIGHT, HEIGHT)]
    )
    local = (points - view.position) @ view.rotation
    size = np.array([CAMERA.width, CAMERA.height])
    if right == 0.0:
        if (local[:, 2] > MIN_DEPTH).all():
            pixels = CAMERA.project(local)
            assert (pixels.max(axis=0) < 2.0).any() or (pixels.min(axis=0) > size - 2.0).any()
        return
    pixels = CAMERA.project(local)
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    assert cut == ((low < 0.0).any() or (high > size).any())
    assert (left, top) == tuple(np.floor(np.maximum(low, 0.0)))
    assert (right, bottom) == tuple(np.minimum(np.floor(high) + 1.0, size))


@given(turn=st.floats(-3.1, 3.1), offset=st.floats(-0.5, 0.5))
def test_what_is_hidden_is_the_overlap_of_two_intervals_of_azimuth(turn, offset):
    """In every direction: azimuths meet at half a turn."""
    near, far = 1.0, 2.0
    there = np.array(
        [
            [near * np.cos(turn), near * np.sin(turn)],
            [far * np.cos(turn + offset), far * np.sin(turn + offset)],
        ]
    )
    sizes = np.array([[0.2, HEIGHT], [0.2, HEIGHT]])
    views = project_all(there, sizes, np.zeros(2, bool), view_of(CAMERA, pose()), False)
    a, b = np.arcsin(0.2 / near), np.arcsin(0.2 / far)
    overlap = min(b, offset + a) - max(-b, offset - a)
    assert views[:, DISTANCE] == pytest.approx([near, far])
    assert views[0, HIDDEN] == 0.0
    assert views[1, HIDDEN] == pytest.approx(max(0.0, overlap / (2.0 * b)), abs=1e-9)


@given(position=positions, tilt=st.floats(-0.8, 0.5))
def test_a_beacon_is_visible_with_its_seam_and_a_part_of_both_colours(position, tilt):
    view, height = pose(float(np.arctan2(position[1], position[0])), tilt), 0.6
    camera = view_of(CAMERA, view)[0]
    shown = project(*position, 0.05, height, True, camera, False)
    whole = project(*position, 0.05, height, False, camera, False)
    seam = (np.array([*position, 0.5 * height]) - view.position) @ view.rotation
    row = CAMERA.project(seam[None])[0, 1] if seam[2] > MIN_DEPTH else -1.0
    assert shown in (whole, (0.0, 0.0, 0.0, 0.0, False))
    if whole[2] and np.hypot(*position) > 1.0 and 15.0 < row < CAMERA.height - 15.0:
        assert shown == whole
    if not 2.0 < row < CAMERA.height - 2.0:
        assert shown[2] == 0.0


def test_the_camera_sees_a_mover_where_it_waits(world, silent):
    """Without the robot in front of it, it would be 1.4 m away."""
    lane = Shuttle((1.2, 0.0), (-0.2, 0.0), 0.2)
    mover = Obstacle((1.2, 0.0), 0.08, 0.3, "red", lane, yields=True)
    layout, model = world(mover)
    layout = replace(layout, reactions=Reactions(robot_radius=0.12))
    body = KinematicBody(model, load_robot("hsr8"), layout, silent, np.random.default_rng(0))
    body.data.joint("head_tilt").qpos[0] = -0.35
    targets = JointTargets(body.sense().joint_position.copy(), body.sense().joint_position.copy())
    for _ in range(2800):
        body.apply(targets)
    constants = CameraModel(CAMERA.horizontal_fov, pi, shadow=OPEN)
    settings = AHEAD.model_copy(update=SIZE)
    camera = AnalyticCamera(layout, settings, constants, np.random.default_rng(1), CameraFaults())
    detections = [d for d in camera.capture(body) if d.kind == "obstacle"]
    (position,) = body.movers().tolist()
    assert body.truth().mover_clocks < 7.0
    assert [d.distance for d in detections] == [pytest.approx(position[0], abs=0.02)]
    assert lane.position(14.0)[0] - position[0] > 0.5
