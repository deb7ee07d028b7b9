"""Whole runs for the system tests."""

import sys
from pathlib import Path

import pytest

from hsr8.loop import Simulation
from hsr8.scenario.loader import load_scenario

# `scaled_model` is a script; scripts are not a package.
sys.path.insert(0, str(Path(__file__).parents[2] / "scripts"))


class Recorded:
    """A listener that keeps everything."""

    def __init__(self):
        self.records = []
        self.events = []
        self.reason = None

    def on_record(self, record):
        self.records.append(record)

    def on_event(self, time, kind, text):
        self.events.append((time, kind, text))

    def close(self, exit_reason):
        self.reason = exit_reason

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
        recorded = Recorded()
        simulation = Simulation(load_scenario(name, settings), seed, [recorded])
        return simulation.run(), recorded, simulation

    return run
