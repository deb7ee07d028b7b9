"""What a run will take: time on the clock, room on the disk."""

from dataclasses import dataclass

from hsr8.recorder.log_level import LogLevel
from hsr8.scenario.schema import Scenario

# Measured with `course` on two cores without a graphics card [s], [s per simulated second].
START = 3.0  # before the first tick
LOOP = 0.055  # belief, decisions, walking, records
PHYSICS = 0.075  # in addition, of a body with dynamics
PICTURES = 0.025  # in addition, of a camera that is rendered
RECORD_RATE = 0.1  # megabytes of records per simulated second
LOG_RATES = {  # and of the log beside them
    LogLevel.MINIMAL: 0.1,
    LogLevel.STANDARD: 0.18,
    LogLevel.FULL: 0.43,
}


@dataclass(frozen=True, slots=True)
class Cost:
    """An estimate for a run that goes on to its last second.

    Attributes:
        simulated: at most [s].
        wall: about, on two cores [s].
        disk: about [MB].
    """

    simulated: float
    wall: float
    disk: float


def estimate(scenario: Scenario, *, log: LogLevel | None = LogLevel.STANDARD) -> Cost:
    """Cost of one run of `scenario`, with a Rerun log of a level or without."""
    seconds = scenario.duration
    rate = RECORD_RATE + (0.0 if log is None else LOG_RATES[log])
    return Cost(seconds, START + seconds * _slowness(scenario), seconds * rate)


def _slowness(scenario: Scenario) -> float:
    """Wall time of a simulated second [s]."""
    slowness = LOOP
    if scenario.robot.body == "full":
        slowness += PHYSICS
    if scenario.camera.source == "rendered":
        slowness += PICTURES
    return slowness
