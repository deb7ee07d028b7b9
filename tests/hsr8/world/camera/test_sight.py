"""The detector finds what geometry expects in the rendered image: obstacles and beacons."""

from dataclasses import replace
from math import atan2

import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.robot_builder import build_model, camera_model
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.camera.analytic import project
from hsr8.world.camera.rendered import RenderedCamera
from hsr8.world.field.layout import Beacon, Obstacle
from navigation.belief.visibility import Viewpoint, clear_points
from navigation.observation import CameraModel, CameraView
from vision.detector import Detector
from vision.parameters import PoseParameters
from vision.self_mask import BodyPart
from vision.view import view_of
from walking.state import HeadCameraPose

NOTHING = np.zeros((0, 2)), np.zeros(0)
SIGMA = PoseParameters(0.005, 0.005, 0.005, 0.005)


@pytest.mark.gl
def test_near_obstacles_are_found_where_they_are_expected(world, silent):
    """Of near obstacles next to the robot, whose foot its arms may hide, some are missed."""
    scenario = load_scenario("walk", [])
    robot = load_robot("hsr8")
    layout, _ = world(Obstacle((1.0, 0.0), 0.065, 0.3, "red"), beacons=())
    camera = camera_model(scenario, layout.sizes)
    model = build_model(scenario, layout)
    body = KinematicBody(model, robot, layout, silent, np.random.default_rng(0))
    parameters = replace(scenario.vision, pose=SIGMA)
    detector = Detector(
        scenario.camera.pinhole, parameters, tuple(BodyPart(*arm) for arm in robot.arms)
    )
    fov = camera.horizontal_fov, camera.vertical_fov
    eyes = RenderedCamera(model, scenario.camera, np.random.default_rng(0))
    obstacle = next(
        b for b in range(model.nbody) if model.body(b).name.startswith("field/obstacle_")
    )
    rng, found = np.random.default_rng(2), {True: [], False: []}
    for _ in range(400):
        pan, tilt = rng.uniform(-1.5, 1.5), rng.uniform(-1.0, -0.2)
        distance, bearing = rng.uniform(0.27, 0.75), pan + rng.uniform(-0.5, 0.5)
        point = distance * np.array([np.cos(bearing), np.sin(bearing)])
        body.data.joint("head_pan").qpos[0] = pan
        body.data.joint("head_tilt").qpos[0] = tilt
        model.body_pos[obstacle, :2] = point
        image = eyes.capture(body)()
        rotation = body.data.camera(HEAD_CAMERA).xmat.reshape(3, 3) * (1.0, -1.0, -1.0)
        position = body.data.camera(HEAD_CAMERA).xpos.copy()
        view = CameraView(rotation, position, pan, tilt, camera)
        looked, foot = (
            clear_points(point[None], *Viewpoint.of(v, np.zeros(3), 2.5, 0.07), *NOTHING)[0]
            for v in (view, replace(view, model=CameraModel(*fov)))
        )
        if not foot:
            continue  # the foot is outside the image
        detections = detector.detect(image, HeadCameraPose(rotation, position, pan, tilt))
        x, y = point.tolist()
        off = [np.hypot(d.distance - distance, d.bearing - atan2(y, x)) for d in detections]
        found[bool(looked)].append(min(off, default=9.0) < 0.2)
    eyes.close()
    assert len(found[True]) > 50
    assert np.mean(found[True]) > 0.99
    assert len(found[False]) > 15
    assert np.mean(found[False]) < 0.95


@pytest.mark.gl
def test_a_beacon_is_detected_where_its_seam_is_in_the_image(world, silent):
    """Borders that cut one of its colours change neither the detection nor its errors."""
    scenario, robot = load_scenario("walk", []), load_robot("hsr8")
    layout, _ = world(beacons=(Beacon("yellow/cyan", (2.0, 0.0), "yellow", "cyan"),))
    model = build_model(scenario, layout)
    body = KinematicBody(model, robot, layout, silent, np.random.default_rng(0))
    camera, parameters = scenario.camera.pinhole, replace(scenario.vision, pose=SIGMA)
    detector = Detector(camera, parameters, tuple(BodyPart(*arm) for arm in robot.arms))
    eyes = RenderedCamera(model, scenario.camera, np.random.default_rng(0))
    beacon = model.body("field/beacon_yellow_cyan").id
    rng, detected, errors = np.random.default_rng(3), {True: [], False: []}, []
    for _ in range(150):
        tilt, distance = rng.uniform(-0.75, 0.55), rng.uniform(0.6, 3.8)
        body.data.joint("head_tilt").qpos[0] = tilt
        model.body_pos[beacon, :2] = distance, 0.0
        image = eyes.capture(body)()
        rotation = body.data.camera(HEAD_CAMERA).xmat.reshape(3, 3) * (1.0, -1.0, -1.0)
        pose = HeadCameraPose(rotation, body.data.camera(HEAD_CAMERA).xpos.copy(), 0.0, tilt)
        position = (distance - float(pose.position[0]), -float(pose.position[1]))
        box = project(*position, 0.05, 0.6, True, view_of(camera, pose)[0], False)
        cut = bool(box[4])
        seam = (np.array([distance, 0.0, 0.3]) - pose.position) @ rotation
        row = float(camera.project(seam[None])[0, 1])
        if min(abs(row), abs(row - camera.height)) < 8.0:
            continue  # at the border
        found = [d for d in detector.detect(image, pose) if d.kind == "beacon"]
        detected[box[2] > 0.0].append(len(found))
        if cut and found:
            errors.append((found[0].distance - distance) / found[0].covariance[0, 0] ** 0.5)
    eyes.close()
    assert set(detected[True]) == {1}
    assert set(detected[False]) == {0}
    assert len(errors) > 20
    assert np.mean(np.square(errors)) < 2.5
