"""A run of `crowd` with its camera frames and the vetoes of its safety filter, for images."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from unittest.mock import patch

from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation
from hsr8.simulation.record import TickRecord
from hsr8.world.field.layout import Layout
from navigation.motion import rollout
from navigation.motion.safety_filter import RolloutStart, SafetyFilter

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SEED, DURATION = 3, 40.0


@dataclass(frozen=True)
class Veto:
    """Decision of the safety filter against the desired velocity.

    Attributes:
        start: start of the rollout.
        desired: desired velocity in W (2,) [m/s].
        discs: collision hypotheses, records of type `Disc` (m,).
        paths: positions of every candidate after each footstep (n, steps + 1, 2) [m].
        loss: loss of every candidate (n,) [s].
    """

    start: RolloutStart
    desired: Array
    discs: NDArray[np.record]
    paths: Array
    loss: Array


@dataclass(frozen=True)
class CrowdRun:
    """Run of `crowd` for the images.

    Attributes:
        layout: layout of the world.
        records: records with a camera frame.
        vetoes: decisions of the safety filter by the time of their frame.
        fov: horizontal and vertical field of view of the camera [rad].
    """

    layout: Layout
    records: list[TickRecord]
    vetoes: dict[float, Veto]
    fov: tuple[float, float]


@cache
def crowd() -> CrowdRun:
    """Run `crowd` and return its frames."""
    scenario = load_scenario("crowd", ["robot.body=kinematic", f"duration={DURATION}"])
    records: list[TickRecord] = []
    vetoes: dict[float, Veto] = {}
    with watched() as latest, Simulation(scenario, SEED) as simulation:
        for tick in simulation:
            if tick.record is None or tick.record.frame is None:
                continue
            records.append(tick.record)
            if latest:
                vetoes[tick.record.frame.time] = latest.pop()
        camera = scenario.camera.pinhole
        layout = simulation.layout
    return CrowdRun(layout, records, vetoes, (camera.horizontal_fov, camera.vertical_fov))


@contextmanager
def watched() -> Iterator[list[Veto]]:
    """Yield a list with the latest veto of the safety filter, or empty once it is taken."""
    vetoes: list[Veto] = []
    choose = SafetyFilter.choose

    def watch(
        self: SafetyFilter, start: RolloutStart, desired: Array, discs: NDArray[np.record]
    ) -> tuple[Array, float]:
        chosen = choose(self, start, desired, discs)
        if chosen[0] is not desired:
            fan = self.candidates(desired, start.course)
            loss = self.risk(start, fan, discs) + self.delay(start, fan)
            step = self._limits.footstep
            heading = float(start.pose[2])
            velocity, _ = rollout.walked(self.rollout(start, fan), heading, step)
            moved = np.cumsum(step * velocity, axis=1)
            paths = start.pose[:2] + np.concatenate([np.zeros((len(fan), 1, 2)), moved], axis=1)
            vetoes[:] = [Veto(start, desired, discs, paths, loss)]
        return chosen

    with patch.object(SafetyFilter, "choose", watch):
        yield vetoes
