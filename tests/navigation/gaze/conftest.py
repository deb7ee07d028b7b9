"""Fixtures: gaze planners, and their decisions one after another."""

from dataclasses import replace

import numpy as np
import pytest

from navigation.gaze.planner import GazePlanner
from navigation.parameters.navigation import NavigationParameters
from navigation.scene import Scene

P = NavigationParameters()
BEACONS = {"cyan/yellow": (2.9, 0.5), "yellow/cyan": (-2.9, 0.0), "magenta/cyan": (0.5, 2.9)}
NECK = (3.0, 40.0)


class Chooser:
    """Gaze planner with its memory."""

    def __init__(self, parameters, limits, task, beacons):
        self.parameters, self.task = parameters, task
        self.planner = GazePlanner(parameters, limits, beacons, NECK)
        self.memory = self.planner.begin()

    def scene(self, belief, target=(2.0, 0.0), motion=None):
        body = np.zeros(3) if motion is None else motion.velocity
        return Scene.of(belief, self.task(target), self.parameters, body=body)

    def __call__(self, belief, target=(2.0, 0.0), motion=None):
        scene = self.scene(belief, target, motion)
        decision, self.memory = self.planner.choose(self.memory, scene, motion)
        return decision


@pytest.fixture(scope="session")
def gaze(limits, task):
    """Builds a gaze with its memory from parameters, or a mode and other fields of the gaze."""

    def make(parameters=P, beacons=BEACONS, **changes):
        p = replace(parameters, gaze=replace(parameters.gaze, **changes))
        return Chooser(p, limits, task, beacons)

    return make
