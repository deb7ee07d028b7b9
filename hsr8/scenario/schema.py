"""Scenario: all that determines a run."""

from dataclasses import dataclass
from operator import index
from typing import Annotated, Literal, Self, SupportsIndex

from annotated_types import Interval, Len, doc
from pydantic import Field

from hsr8.errors import ScenarioError
from hsr8.scenario.fault import Disturbance, Fault
from hsr8.scenario.mission import Command, Mission
from hsr8.scenario.plugin import Plugin
from hsr8.scenario.robot import NOMINAL_SPEED, Robot
from hsr8.scenario.section import PeriodMs, Section
from hsr8.scenario.sensors import Camera, SensorNoise
from hsr8.scenario.world import World
from navigation.decision import SpeedLimits
from navigation.parameters.belief import BeliefParameters
from navigation.parameters.navigation import NavigationParameters
from vision.parameters import VisionParameters
from walking.parameters import WalkingParameters

MAX_SEED = 2**63 - 1  # integers of TOML have 64 bits


@dataclass(frozen=True)
class Navigation(NavigationParameters):
    """Gaze, planner and mission; the profile sets the defaults."""

    profile: Annotated[
        Literal["extended", "paper"],
        doc("extended: the default planner and gaze; paper: the method and gaze of the paper."),
    ] = "extended"


class Criteria(Section):
    """Criteria of success."""

    max_falls: Annotated[int, Interval(ge=0, le=1000), doc("Maximum number of falls [1].")] = 0
    max_collisions: Annotated[
        Annotated[int, Interval(ge=0, le=100_000)] | None,
        doc("Maximum number of collisions; default: any number [1]."),
    ] = None
    goal_reached: Annotated[bool, doc("Whether the goal must be reached.")] = False
    max_zmp_outside_ticks: Annotated[
        Annotated[int, Interval(ge=0, le=10_000_000)] | None,
        doc("Maximum number of control ticks with the planned ZMP outside the soles [1]."),
    ] = None
    min_via_points: Annotated[
        int, Interval(ge=0, le=100_000), doc("Minimum number of via points passed [1].")
    ] = 0


class Recorder(Section):
    """Recording of the run."""

    period_ms: Annotated[
        PeriodMs, doc("Period of the records, a multiple of the control tick of 5 ms [ms].")
    ] = 20
    images: Annotated[
        Literal["none", "standard", "full"],
        doc("Rendered images that are kept: none, one per 0.18 s, or all, in a higher quality."),
    ] = "standard"
    space_scale: Annotated[
        Annotated[float, Interval(gt=0.0, le=100.0)] | None,
        doc(
            "Factor on the intimate, personal and social space of a mover in the metrics, 0.45, "
            "1.2 and 3.6 m; 1: literal metres; default: height of the mover over 1.7 m [1]."
        ),
    ] = None


class Scenario(Section):
    """World, robot, mission and criteria of success."""

    name: Annotated[
        str,
        Len(1, 64),
        Field(pattern=r"^[\p{L}\p{N}][\p{L}\p{M}\p{N}._-]*$"),
        doc(
            "Name of the run folders, letters and digits of any script; default: the name of the "
            "file."
        ),
    ]
    description: Annotated[str, Len(0, 2000), doc("Description in one or two sentences.")] = ""
    seed: Annotated[
        int, Interval(ge=0, le=MAX_SEED), doc("Seed of the world and of all noise [1].")
    ] = 0
    duration: Annotated[
        float, Interval(gt=0.0, le=7200.0), "s", doc("Maximum simulated time [s].")
    ] = 240.0
    world: Annotated[World, doc("Field, obstacles, beacons and light.")] = World()
    mission: Annotated[Mission, doc("Via points and goal.")]
    command: Annotated[Command, doc('Velocities or footsteps of a mission of kind "walk".')] = (
        Command()
    )
    disturbance: Annotated[Disturbance, doc("Random pushes.")] = Disturbance()
    fault: Annotated[
        tuple[Fault, ...], Len(0, 64), doc("Faults of sensors, servos and the environment.")
    ] = ()
    robot: Annotated[Robot, doc("Body, initial pose and speed limits.")] = Robot()
    camera: Annotated[Camera, doc("Head camera.")] = Camera()
    sensors: Annotated[SensorNoise, doc("Noise of encoders, IMU and foot force sensors.")] = (
        SensorNoise()
    )
    walking: Annotated[
        WalkingParameters, doc("Walking engine; defaults scale with the size of the robot.")
    ] = WalkingParameters()
    vision: Annotated[VisionParameters, doc("Obstacle and beacon detector.")] = VisionParameters()
    belief: Annotated[BeliefParameters, doc("Localization, obstacle tracks and local map.")] = (
        BeliefParameters()
    )
    navigation: Annotated[Navigation, doc("Gaze and motion planning.")] = Navigation()
    plugin: Annotated[Plugin, doc("User-defined planner and gaze.")] = Plugin()
    criteria: Annotated[Criteria, doc("Criteria of success.")] = Criteria()
    recorder: Annotated[Recorder, doc("Recording of the run.")] = Recorder()

    def with_seed(self, seed: SupportsIndex) -> Self:
        """Return the scenario with another seed.

        Raises:
            ScenarioError: the seed is invalid.
        """
        try:
            number = int(index(seed))
        except TypeError:
            number = -1
        if not 0 <= number <= MAX_SEED:
            raise ScenarioError(f"seed={seed!r}: expected an integer from 0 to {MAX_SEED:_}")
        return self.model_copy(update={"seed": number})

    @property
    def time_scale(self) -> float:
        """Time in which the robot walks across the world, relative to HSR-VIII [1]."""
        return self.world.scale * (NOMINAL_SPEED / self.robot.speed.vx)

    def speed_limits(self) -> SpeedLimits:
        """Return the speed limits of navigation, whose commands last for one footstep."""
        speed = self.robot.speed
        return SpeedLimits(
            vx=speed.vx,
            vx_backward=speed.vx_backward,
            vy=speed.vy,
            wz=speed.wz,
            acceleration=speed.acceleration,
            footstep=self.walking.gait.footstep_time,
        )
