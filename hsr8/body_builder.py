"""Builder of the world model and the body of a scenario."""

from dataclasses import replace

import mujoco

from hsr8.robots.files import reading_models
from hsr8.robots.loaded import load_robot
from hsr8.scenario.schema import Scenario
from hsr8.seeds import named_rng
from hsr8.world.body.body import Body
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.body.physics import PhysicsBody
from hsr8.world.body.pushes import schedule
from hsr8.world.field.layout import Layout
from hsr8.world.model.assembly import Optics, assemble
from walking.parameters import CONTROL_PERIOD


def build_model(scenario: Scenario, layout: Layout) -> mujoco.MjModel:
    """Return the world model of `scenario` for the camera of the robot."""
    robot = load_robot(scenario.robot.model)
    camera = scenario.camera
    fov = camera.vertical_fov
    brightness = scenario.world.brightness
    optics = Optics(camera.width, camera.height, fov, brightness, camera.shadows)
    return assemble(robot, layout, "vision", optics)


def build_body(scenario: Scenario, seed: int, layout: Layout, model: mujoco.MjModel) -> Body:
    """Return the body of the robot in `model`; `seed` draws noise and random pushes.

    Raises:
        ModelError: the control period is not a multiple of the physics step.
    """
    robot = load_robot(scenario.robot.model)
    noise, rng = scenario.sensors, named_rng(seed, "body")
    if scenario.robot.body == "kinematic":
        return KinematicBody(model, robot, layout, noise, rng)
    scheduled = schedule(
        scenario.disturbance,
        scenario.duration,
        CONTROL_PERIOD,
        named_rng(seed, "push"),
        scenario.fault,
    )
    pushes = [replace(push, body=robot.body_name(push.body)) for push in scheduled]
    with reading_models():
        return PhysicsBody(model, robot, layout, noise, rng, pushes=pushes, faults=scenario.fault)
