"""Builds the robot side for a scenario: the only place where its parts meet."""

from math import pi

import numpy as np

from hsr8.decisions import Decisions, GazeController, Goes, MotionPlanner
from hsr8.errors import ScenarioError, UsageError
from hsr8.plugin_decisions import PluginGaze, PluginPlanner
from hsr8.plugin_file import load_plugin
from hsr8.robot import Robot
from hsr8.scenario.mission import Walk
from hsr8.scenario.schema import Scenario
from hsr8.script import CommandScript, ScriptedMission, ScriptedPlanner, command_script
from hsr8.seeds import named_rng
from hsr8.world.field.layout import Layout
from hsr8.world.model.models import models_dir, reading_models
from navigation.baselines.choice import build_planner
from navigation.belief.estimator import Estimator
from navigation.gaze.planner import GazePlanner
from navigation.mission import Mission
from navigation.motion.landmark_obstacles import LandmarkObstacles
from vision.camera import PinholeCamera
from vision.detector import Detector
from vision.self_mask import BodyPart
from walking.body.robot_model import RobotModel
from walking.parameters import WalkingParameters
from walking.similarity import parameters_for
from walking.walker import Walker

# The arms as the head sees them, with room for their swing: shoulder, elbow, hand in R [m].
# Measured over 25 s of walking: shoulders move 2 mm, hands 2 cm.
ARM_X = (0.0, -0.012, 0.018)
ARM_Y = (0.087, 0.096, 0.106)
ARM_Z = (0.378, 0.305, 0.225)
ARM_RADII = (0.029, 0.032, 0.045)
OMNIDIRECTIONAL = (2.0 * pi, pi)  # field of view of a camera that sees everything [rad]
MARGINS = (("pattern", "sole_margin"), ("pattern", "plan_margin"), ("stabilizer", "sole_margin"))
START_SIGMA = (0.02, 0.02, 0.02)  # how well the robot knows where it starts [m, m, rad]


def field_of_view(scenario: Scenario, camera: PinholeCamera) -> tuple[float, float]:
    """Horizontal and vertical field of view of what the robot sees with [rad]."""
    if scenario.camera.omnidirectional:
        return OMNIDIRECTIONAL
    return camera.horizontal_fov, camera.vertical_fov


def build_robot(
    scenario: Scenario,
    layout: Layout,
    seed: int,
    *,
    planner: MotionPlanner | None = None,
    gaze: GazeController | None = None,
) -> Robot:
    """The robot of `scenario`, placed by `layout`; `seed` draws its particles and commands.

    A `planner` or a `gaze` takes the place of the scenario's.
    """
    camera = head_camera(scenario)
    body = robot_model()
    script = build_script(scenario, named_rng(seed, "command"))
    return Robot(
        walking=Walker(body, walking_parameters(body, scenario)),
        fov=field_of_view(scenario, camera),
        vision=Detector(camera, scenario.vision, arms()),
        pose=scenario.vision.pose,
        shutter=1e-3 * scenario.camera.shutter_ms,
        belief=build_estimator(scenario, layout, named_rng(seed, "belief")),
        decisions=build_decisions(scenario, layout, seed, script, planner=planner, gaze=gaze),
        script=script,
    )


def walking_parameters(body: RobotModel, scenario: Scenario) -> WalkingParameters:
    """Parameters of walking for the robot `body`.

    Raises:
        ScenarioError: a margin leaves nothing of its soles.
    """
    parameters = parameters_for(body, scenario.walking)
    half = body.sole.half_width
    for section, margin in MARGINS:
        kept = getattr(getattr(parameters, section), margin)
        if kept >= half:
            raise ScenarioError(
                f"walking.{section}.{margin}: {kept:g} must be below half the width of the "
                f"robot's sole, {half:g}"
            )
    return parameters


@reading_models()
def robot_model() -> RobotModel:
    """Everything the walking engine must know of HSR-VIII.

    Raises:
        ModelError: its file will not do.
    """
    return RobotModel.from_mjcf(models_dir() / "hsr8" / "hsr8.xml")


def head_camera(scenario: Scenario) -> PinholeCamera:
    """Intrinsics of the head camera of `scenario`."""
    camera = scenario.camera
    fov = camera.vertical_fov
    return PinholeCamera.from_vertical_fov(camera.width, camera.height, fov)


def build_script(scenario: Scenario, rng: np.random.Generator) -> CommandScript | None:
    """The commands of a walk; None where the robot decides by itself."""
    if not isinstance(scenario.mission, Walk):
        return None
    return command_script(scenario.command, scenario.duration, rng)


def build_decisions(
    scenario: Scenario,
    layout: Layout,
    seed: int,
    script: CommandScript | None,
    *,
    planner: MotionPlanner | None = None,
    gaze: GazeController | None = None,
) -> Decisions:
    """Mission, planner and gaze of the robot of `scenario`.

    With a `script`, it is obeyed; `seed` is for a planner that draws samples. A `planner` or a
    `gaze` takes the place of the scenario's.

    Raises:
        UsageError: a `planner` or a `gaze`, given or named by the scenario, is none, or there is
            a planner beside a `script`.
    """
    plugin, navigation, limits = scenario.plugin, scenario.navigation, scenario.speed_limits()
    if planner is None and plugin.planner:
        planner = load_plugin(plugin.planner)
    if gaze is None and plugin.gaze:
        gaze = load_plugin(plugin.gaze)
    beacons = known_beacons(scenario, layout)
    mission: Goes
    moves: MotionPlanner
    looks: GazeController
    if script is not None:
        if planner is not None:
            raise UsageError(
                f"scenario {scenario.name!r}: a mission of kind 'walk' obeys the section command "
                "and asks no planner; give one to a mission of another kind"
            )
        mission, moves = ScriptedMission(), ScriptedPlanner(script)
    else:
        mission = Mission(layout.waypoints, layout.goal_heading, layout.endless, navigation.mission)
        if planner is None:
            moves = build_planner(navigation, limits, named_rng(seed, "planner"))
        else:
            moves = PluginPlanner(planner)
    if gaze is None:
        fov = field_of_view(scenario, head_camera(scenario))
        looks = GazePlanner(navigation, limits, beacons, *fov)
    else:
        looks = PluginGaze(gaze)
    return Decisions(
        mission=mission,
        planner=moves,
        gaze=looks,
        landmarks=LandmarkObstacles(
            beacons, scenario.vision.beacon_radius, scenario.navigation.landmarks
        ),
        footstep=limits.footstep,
    )


def known_beacons(scenario: Scenario, layout: Layout) -> dict[str, tuple[float, float]]:
    """Where the robot takes the beacons to be, by name [m]; empty if it has no map of them."""
    if scenario.belief.localization.landmarks == "mapped":
        return {}
    return {b.name: b.believed for b in layout.beacons}


def build_estimator(scenario: Scenario, layout: Layout, rng: np.random.Generator) -> Estimator:
    """The belief of the robot of `scenario`; `rng` draws its particles."""
    return Estimator(
        scenario.belief,
        known_beacons(scenario, layout),
        np.array(layout.start),
        np.diag(np.square(START_SIGMA)),
        rng,
    )


def arms() -> tuple[BodyPart, ...]:
    """Both arms of the robot, hanging."""
    radii = np.array(ARM_RADII)
    return tuple(
        BodyPart(np.column_stack([ARM_X, side * np.array(ARM_Y), ARM_Z]), radii)
        for side in (1.0, -1.0)
    )
