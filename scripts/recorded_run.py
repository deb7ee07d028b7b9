"""A short run of the real loop, kept in memory."""

from dataclasses import dataclass, field

from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.simulation.decisions import FrameRecord
from hsr8.simulation.loop import Simulation
from hsr8.simulation.record import TickRecord

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass
class RecordedRun:
    """Motion and camera frames of a run, as the figures need them.

    Attributes:
        time: time of every record [s].
        robot: true x, y, heading of every record [m, m, rad].
        movers: true positions of every record (m, 2) [m].
        contact: whether anything touched, of every record.
        frames: every camera frame.
    """

    n_movers: int
    scenario: Scenario
    time: list[float] = field(default_factory=list)
    robot: list[Array] = field(default_factory=list)
    movers: list[Array] = field(default_factory=list)
    contact: list[bool] = field(default_factory=list)
    frames: list[FrameRecord] = field(default_factory=list)

    def keep(self, record: TickRecord) -> None:
        """Keep a record."""
        truth = record.truth
        self.time.append(record.time)
        self.robot.append(np.array(truth.robot))
        places = np.reshape(truth.obstacle_positions, (-1, 2))
        self.movers.append(places[len(places) - self.n_movers :].copy())
        self.contact.append(bool(truth.contacts))
        if record.frame is not None:
            self.frames.append(record.frame)

    def at(self, time: float) -> int:
        """Number of the last record not after `time` [s]."""
        return max(0, int(np.searchsorted(self.time, time + 1e-9)) - 1)


def run(name: str, settings: tuple[str, ...], seed: int, duration: float) -> RecordedRun:
    """Run a scenario for at most `duration` [s].

    Args:
        name: name of the scenario.
        settings: like ``--set`` of `hsr8 run`.
        seed: seed of world and noise.
        duration: simulated time [s].
    """
    scenario = load_scenario(name, [*settings, f"duration={duration}"])
    with Simulation(scenario, seed) as simulation:
        kept = RecordedRun(len(simulation.layout.movers), scenario)
        for tick in simulation:
            if tick.record is not None:
                kept.keep(tick.record)
    return kept
