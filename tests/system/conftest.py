"""Whole runs for the system tests."""

import pytest

from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation


class Recorded:
    """Records and events of a run."""

    def __init__(self, ticks):
        self.records = [tick.record for tick in ticks if tick.record is not None]
        self.events = [event for tick in ticks for event in tick.events]

    @property
    def frames(self):
        return [r.frame for r in self.records if r.frame is not None]


@pytest.fixture
def simulate():
    """Runs a scenario; returns outcome, records and the simulation."""

    def run(name, *overrides, seed=0, body="kinematic", camera="analytic", duration=None):
        settings = [f'robot.body="{body}"', f'camera.source="{camera}"', *overrides]
        if duration is not None:
            settings.append(f"duration={duration}")
        with Simulation(load_scenario(name, settings), seed) as simulation:
            recorded = Recorded(list(simulation))
        return simulation.outcome(), recorded, simulation

    return run
