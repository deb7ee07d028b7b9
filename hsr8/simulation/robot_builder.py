"""Builders of a scenario: the world model, the body, and the robot side."""

from dataclasses import replace
from functools import partial
from math import inf, pi

import mujoco
import numpy as np

from hsr8.errors import ScenarioError, UsageError
from hsr8.plugins.decisions import GazePlugin, Limits, PlannerPlugin, PluginGaze, PluginPlanner
from hsr8.plugins.file import load_named
from hsr8.plugins.walker import CustomWalker, PluginEngine, PluginWalker, RobotInfo
from hsr8.robots.file.files import reading_models
from hsr8.robots.loaded import LoadedRobot, load_robot
from hsr8.robots.model.posed_shapes import ground_shadow
from hsr8.scenario.mission import Walk
from hsr8.scenario.schema import Scenario
from hsr8.seeds import named_rng
from hsr8.simulation.command_schedule import (
    CommandSchedule,
    ScheduledMission,
    ScheduledPlanner,
    command_schedule,
)
from hsr8.simulation.controller import Robot
from hsr8.simulation.decisions import Decisions, GazeController, MissionPlanner, MotionPlanner
from hsr8.simulation.drive import Drive, DrivenGaze
from hsr8.world.body.body import Body
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.body.physics import PhysicsBody
from hsr8.world.body.pushes import schedule
from hsr8.world.field.layout import Layout
from hsr8.world.model.assembly import Optics, assemble
from navigation.baselines.choice import build_planner
from navigation.belief.estimator import Estimator
from navigation.gaze.planner import GazePlanner
from navigation.mission import Mission
from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.observation import CameraModel
from vision.detector import Detector
from vision.self_mask import BodyPart
from vision.sizes import Sizes
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.walker import Walker

MARGINS = (("pattern", "sole_margin"), ("stabilizer", "sole_margin"))
# Standard deviation of the known start position in a world of scale 1 [m] and heading [rad].
START_SIGMA, START_HEADING_SIGMA = 0.02, 0.02


def field_of_view(scenario: Scenario) -> tuple[float, float]:
    """Return the horizontal and vertical field of view of the robot's camera [rad]."""
    camera = scenario.camera.pinhole
    if scenario.camera.source == "omnidirectional":
        return 2.0 * pi, pi
    if scenario.camera.source == "neck-reach":
        return 2.0 * scenario.navigation.gaze.max_pan + camera.horizontal_fov, pi
    return camera.horizontal_fov, camera.vertical_fov


def camera_model(scenario: Scenario, sizes: Sizes) -> CameraModel:
    """Return the constants of the robot's camera for navigation."""
    humanoid, camera = load_robot(scenario.robot.model), scenario.camera
    body = humanoid.model
    height = humanoid.height + float(body.frame_pose(body.tree.camera, body.ready)[1][2])
    return CameraModel(
        *field_of_view(scenario),
        scenario.vision.pose.yaw_sigma,
        inf if camera.panoramic else camera.blind_above,
        sizes.top,
        sizes.obstacle_height[0],
        0.5 * sizes.beacon_height,
        ground_shadow(humanoid.arms, height),
    )


def build_robot(
    scenario: Scenario,
    layout: Layout,
    seed: int,
    *,
    planner: PlannerPlugin | None = None,
    gaze: GazePlugin | None = None,
    walker: CustomWalker | None = None,
    drive: Drive | None = None,
) -> Robot:
    """Return the robot of `scenario` in `layout`.

    Args:
        scenario: what to build.
        layout: start pose, waypoints and beacons.
        seed: draws particles, random commands and samples of the planner.
        planner: replaces the motion planner of the scenario.
        gaze: replaces the gaze planner of the scenario.
        walker: replaces the walking engine of the scenario.
        drive: commands from outside.
    """
    humanoid = load_robot(scenario.robot.model)
    schedule = build_schedule(scenario, named_rng(seed, "command"))
    return Robot(
        walking=build_walker(scenario, walker),
        camera=camera_model(scenario, layout.sizes),
        vision=Detector(
            scenario.camera.pinhole,
            scenario.vision,
            tuple(BodyPart(*arm) for arm in humanoid.arms),
            1e-3 * scenario.camera.shutter_ms,
            layout.sizes,
        ),
        belief=build_estimator(scenario, layout, named_rng(seed, "belief")),
        decisions=build_decisions(
            scenario, layout, seed, schedule, planner=planner, gaze=gaze, drive=drive
        ),
        schedule=drive or schedule,
    )


def build_walker(scenario: Scenario, walker: CustomWalker | None = None) -> Walker:
    """Return the walker of `scenario`.

    Args:
        scenario: what to build.
        walker: replaces the walking engine of the scenario.

    Raises:
        UsageError: the walker, given or named by the scenario, is invalid.
    """
    humanoid = load_robot(scenario.robot.model)
    body = humanoid.model
    if walker is None:
        walker = load_named(scenario.plugin, "walker")
    if walker is None:
        return Walker(body, walking_parameters(humanoid, scenario))
    parameters = scenario.walking
    plugin = PluginWalker(walker, RobotInfo.of(body, humanoid.file))
    return Walker(body, parameters, partial(PluginEngine, plugin, body, parameters))


def walking_parameters(humanoid: LoadedRobot, scenario: Scenario) -> WalkingParameters:
    """Return the walking parameters of `scenario` for its robot.

    Raises:
        ScenarioError: a margin leaves no support area on the soles.
    """
    parameters, half = scenario.walking, humanoid.model.sole.half_width
    for section, margin in MARGINS:
        value = getattr(getattr(parameters, section), margin)
        if value >= half:
            raise ScenarioError(
                f"walking.{section}.{margin}: the sole has no support area left, "
                f"got {value:g}; expected less than half the width of the sole, {half:g}"
            )
    return parameters


def neck(scenario: Scenario) -> tuple[float, float]:
    """Return the maximum rate [rad/s] and acceleration [rad/s²] of the camera."""
    if scenario.navigation.gaze.moved_by == "body":
        limits = scenario.speed_limits()
        return limits.wz, limits.wz / limits.footstep
    head = scenario.walking.head
    return head.max_rate, head.max_acceleration


def build_schedule(scenario: Scenario, rng: np.random.Generator) -> CommandSchedule | None:
    """Return the command schedule of a walk; None where the robot navigates."""
    if not isinstance(scenario.mission, Walk):
        return None
    return command_schedule(scenario.command, scenario.duration, rng)


def build_decisions(
    scenario: Scenario,
    layout: Layout,
    seed: int,
    schedule: CommandSchedule | None,
    *,
    planner: PlannerPlugin | None = None,
    gaze: GazePlugin | None = None,
    drive: Drive | None = None,
) -> Decisions:
    """Return mission, motion planner and gaze planner of `scenario`.

    Args:
        scenario: what to build.
        layout: waypoints and beacons.
        seed: draws the samples of a sampling planner.
        schedule: commands that replace mission and motion planner.
        planner: replaces the motion planner of the scenario.
        gaze: replaces the gaze planner of the scenario.
        drive: commands from outside, which replace the motion planner and the gaze.

    Raises:
        UsageError: the planner or gaze, given or named by the scenario, is invalid, or both a
            planner and a `schedule` are given.
    """
    plugin, navigation, limits = scenario.plugin, scenario.navigation, scenario.speed_limits()
    if planner is None:
        planner = load_named(plugin, "planner")
    if gaze is None:
        gaze = load_named(plugin, "gaze")
    beacons = known_beacons(scenario, layout)
    mission: MissionPlanner
    motion: MotionPlanner
    gaze_planner: GazeController
    if schedule is not None:
        if planner is not None:
            require_planner(scenario)
        mission, motion = ScheduledMission(), ScheduledPlanner(schedule)
    else:
        mission = Mission(layout.waypoints, layout.goal_heading, layout.endless, navigation.mission)
        if planner is None:
            motion = build_planner(navigation, limits, named_rng(seed, "planner"))
        else:
            motion = PluginPlanner(planner, decision_limits(scenario))
    if gaze is None:
        gaze_planner = GazePlanner(navigation, limits, beacons, neck(scenario))
    else:
        gaze_planner = PluginGaze(gaze, decision_limits(scenario))
    if drive is not None:
        motion, gaze_planner = ScheduledPlanner(drive), DrivenGaze(gaze_planner, drive)
    return Decisions(
        mission=mission,
        planner=motion,
        gaze=gaze_planner,
        landmarks=LandmarkObstacles(
            beacons, layout.sizes.beacon_radius, scenario.navigation.landmarks
        ),
        footstep=limits.footstep,
        parameters=navigation,
    )


def decision_limits(scenario: Scenario) -> Limits:
    """Return the limits of motion and gaze of `scenario`."""
    robot = load_robot(scenario.robot.model).model
    return Limits(scenario.speed_limits(), robot.neck.range())


def require_planner(scenario: Scenario) -> None:
    """Require a mission whose motion a planner decides.

    Raises:
        UsageError: the mission is a walk.
    """
    if isinstance(scenario.mission, Walk):
        raise UsageError(
            f"scenario {scenario.name!r}: mission.kind = 'walk' follows the section command "
            "without a planner, got a planner; expected another kind of mission"
        )


def known_beacons(scenario: Scenario, layout: Layout) -> dict[str, tuple[float, float]]:
    """Return the beacon positions on the robot's map, by name [m]; empty without a map."""
    if scenario.belief.localization.landmarks == "mapped":
        return {}
    return {b.name: b.believed for b in layout.beacons}


def build_estimator(scenario: Scenario, layout: Layout, rng: np.random.Generator) -> Estimator:
    """Return the estimator of `scenario`; `rng` draws its particles."""
    sigma = START_SIGMA * scenario.world.scale
    return Estimator(
        scenario.belief,
        known_beacons(scenario, layout),
        np.array(layout.start),
        np.diag(np.square([sigma, sigma, START_HEADING_SIGMA])),
        rng,
    )


def build_model(scenario: Scenario, layout: Layout) -> mujoco.MjModel:
    """Return the world model of `scenario` for the camera of the robot."""
    robot, c = load_robot(scenario.robot.model), scenario.camera
    optics = Optics(c.width, c.height, c.vertical_fov, scenario.world.brightness, c.shadows)
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
