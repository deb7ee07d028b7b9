"""What a run will take: time on the clock, room on the disk."""

from dataclasses import dataclass

from hsr8.recorder.log_level import LogLevel
from hsr8.scenario.schema import Scenario

# Measured on two cores without a graphics card, `course` at its defaults.
REAL_TIME_FACTOR = 3.3
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
    return Cost(seconds, seconds / REAL_TIME_FACTOR, seconds * rate)
