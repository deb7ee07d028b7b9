"""Scenario: all that determines a run."""

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
from hsr8.scenario.robot import NOMINAL_SPEED, Robot
from hsr8.scenario.section import PeriodMs, Section
from hsr8.scenario.sensor_noise import SensorNoise
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

    profile: Literal["extended", "paper"] = "extended"
    """extended: all improvements; paper: the printed equations with minimal corrections."""


class Criteria(Section):
    """Criteria of success."""

    max_falls: Annotated[int, Interval(ge=0, le=1000)] = 0
    """Maximum number of falls [1]."""
    max_collisions: Annotated[int, Interval(ge=0, le=100_000)] | None = None
    """Maximum number of collisions; default: any number [1]."""
    goal_reached: bool = False
    """Whether the goal must be reached."""
    max_zmp_outside_ticks: Annotated[int, Interval(ge=0, le=10_000_000)] | None = None
    """Maximum number of control ticks with the planned ZMP outside the soles [1]."""
    min_via_points: Annotated[int, Interval(ge=0, le=100_000)] = 0
    """Minimum number of via points passed [1]."""


class Recorder(Section):
    """Recording of the run."""

    period_ms: PeriodMs = 20
    """Period of the records, a multiple of the control tick of 5 ms [ms]."""


class Scenario(Section):
    """World, robot, mission and criteria of success."""

    name: Annotated[str, Len(1, 64), Field(pattern=r"^[\p{L}\p{N}][\p{L}\p{M}\p{N}._-]*$")]
    """Name of the run folders, letters and digits of any script; default: the name of the file."""
    description: Annotated[str, Len(0, 2000)] = ""
    """Description in one or two sentences."""
    seed: Annotated[int, Interval(ge=0, le=MAX_SEED)] = 0
    """Seed of the world and of all noise [1]."""
    duration: Annotated[float, Interval(gt=0.0, le=7200.0), "s"] = 240.0
    """Maximum simulated time [s]."""
    world: World = World()
    """Field, obstacles, beacons and light."""
    mission: Mission
    """Via points and goal."""
    command: Command = Command()
    """Velocities or footsteps of a mission of kind "walk"."""
    disturbance: Disturbance = Disturbance()
    """Random pushes."""
    fault: Annotated[tuple[Fault, ...], Len(0, 64)] = ()
    """Faults of sensors, servos and the environment."""
    robot: Robot = Robot()
    """Body, initial pose and speed limits."""
    camera: Camera = Camera()
    """Head camera."""
    sensors: SensorNoise = SensorNoise()
    """Noise of encoders, IMU and foot force sensors."""
    walking: WalkingParameters = WalkingParameters()
    """Walking engine; defaults scale with the size of the robot."""
    vision: VisionParameters = VisionParameters()
    """Obstacle and beacon detector."""
    belief: BeliefParameters = BeliefParameters()
    """Localization, obstacle tracks and local map."""
    navigation: Navigation = Navigation()
    """Gaze and motion planning."""
    plugin: Plugin = Plugin()
    """User-defined planner and gaze."""
    criteria: Criteria = Criteria()
    """Criteria of success."""
    recorder: Recorder = Recorder()
    """Recording of the run."""

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
