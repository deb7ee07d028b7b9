"""The scenario: everything that determines a run but its seed."""

from dataclasses import dataclass
from operator import index
from typing import Annotated, Literal, Self, SupportsIndex

from annotated_types import Interval, Len
from pydantic import Field

from hsr8.errors import ScenarioError
from hsr8.scenario.camera import Camera
from hsr8.scenario.command import Command
from hsr8.scenario.disturbance import Disturbance
from hsr8.scenario.fault import Fault
from hsr8.scenario.mission import Mission
from hsr8.scenario.plugin import Plugin
from hsr8.scenario.robot import Robot
from hsr8.scenario.section import PeriodMs, Section
from hsr8.scenario.sensor_noise import SensorNoise
from hsr8.scenario.world import World
from navigation.decision import SpeedLimits
from navigation.parameters.belief import BeliefParameters
from navigation.parameters.navigation import NavigationParameters
from vision.parameters import VisionParameters
from walking.parameters import WalkingParameters

LARGEST_SEED = 2**63 - 1  # integers of TOML have 64 bits


@dataclass(frozen=True)
class Navigation(NavigationParameters):
    """Parameters of the decisions; the profile gives the defaults of all others."""

    profile: Literal["extended", "paper"] = "extended"
    """extended: our best; paper: the printed equations with the least repairs."""


class Criteria(Section):
    """What a run must achieve to pass."""

    max_falls: Annotated[int, Interval(ge=0, le=1000)] = 0
    """Falls that are still a pass [1]."""
    max_collisions: Annotated[int, Interval(ge=0, le=100_000)] | None = None
    """Contacts with obstacles that are still a pass, any number if left out [1]."""
    goal_reached: bool = False
    """Whether the goal must be reached."""
    max_zmp_outside_ticks: Annotated[int, Interval(ge=0, le=10_000_000)] | None = None
    """Control ticks with the planned ZMP outside the soles that are still a pass [1]."""
    min_via_points: Annotated[int, Interval(ge=0, le=100_000)] = 0
    """Via points that must be passed [1]."""


class Recorder(Section):
    """What is published and kept."""

    period_ms: PeriodMs = 20
    """Time between two records, a multiple of the control tick of 5 ms [ms]."""


class Scenario(Section):
    """A world, a robot in it, what it shall do, and what counts as success."""

    name: Annotated[str, Len(1, 64), Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")]
    """Name that run folders carry; the file's own if left out."""
    description: Annotated[str, Len(0, 2000)] = ""
    """One or two sentences about it."""
    seed: Annotated[int, Interval(ge=0, le=LARGEST_SEED)] = 0
    """Draws the world and every noise [1]."""
    duration: Annotated[float, Interval(gt=0.0, le=7200.0)] = 240.0
    """Simulated time after which the run ends [s]."""
    world: World = World()
    """Field, obstacles, beacons and light."""
    mission: Mission
    """What the robot is asked to do."""
    command: Command = Command()
    """What walking is asked for in a mission of kind "walk"."""
    disturbance: Disturbance = Disturbance()
    """What disturbs the robot."""
    fault: Annotated[tuple[Fault, ...], Len(0, 64)] = ()
    """What fails, when, for how long and how badly."""
    robot: Robot = Robot()
    """Body, start and speeds."""
    camera: Camera = Camera()
    """The head camera."""
    sensors: SensorNoise = SensorNoise()
    """Noise of the body's sensors."""
    walking: WalkingParameters = WalkingParameters()
    """The walking engine; keys left at their default are scaled to the robot's size."""
    vision: VisionParameters = VisionParameters()
    """The detector."""
    belief: BeliefParameters = BeliefParameters()
    """Localization, obstacle tracks and local map."""
    navigation: Navigation = Navigation()
    """Gaze and motion planning."""
    plugin: Plugin = Plugin()
    """User-defined planner and gaze."""
    criteria: Criteria = Criteria()
    """What passes."""
    recorder: Recorder = Recorder()
    """What is published and kept."""

    def with_seed(self, seed: SupportsIndex) -> Self:
        """The same with another seed.

        Raises:
            ScenarioError: it is none.
        """
        try:
            number = int(index(seed))
        except TypeError:
            number = -1
        if not 0 <= number <= LARGEST_SEED:
            raise ScenarioError(
                f"seed={seed!r}: must be a whole number from 0 to {LARGEST_SEED:_}, that draws "
                "the world and every noise"
            )
        return self.model_copy(update={"seed": number})

    def speed_limits(self) -> SpeedLimits:
        """Speed envelope navigation plans with; a command lasts for one footstep."""
        speed = self.robot.speed
        return SpeedLimits(
            vx=speed.vx,
            vx_backward=speed.vx_backward,
            vy=speed.vy,
            wz=speed.wz,
            acceleration=speed.acceleration,
            footstep=self.walking.gait.footstep_time,
        )
