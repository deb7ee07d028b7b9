"""What a run will take: time on the clock, room on the disk."""

from dataclasses import dataclass

from hsr8.scenario.schema import Scenario

# Measured on two cores without a graphics card, `course` at its defaults.
REAL_TIME_FACTOR = 3.3
LOG_RATE = 0.27  # megabytes of log and records per simulated second
RECORD_RATE = 0.1  # the records alone


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


def estimate(scenario: Scenario, *, log: bool = True) -> Cost:
    """Cost of one run of `scenario`, with or without its Rerun log."""
    seconds = scenario.duration
    return Cost(seconds, seconds / REAL_TIME_FACTOR, seconds * (LOG_RATE if log else RECORD_RATE))
