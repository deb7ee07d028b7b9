from dataclasses import replace

import numpy as np
import pytest

from navigation.belief.local_map import LocalMap
from navigation.belief.visibility import Viewpoint
from navigation.gaze.undetected import Undetected, risk_limits
from navigation.parameters.belief import LocalMapParameters
from navigation.parameters.gaze import RiskParameters, UndetectedParameters

P = UndetectedParameters()
LIMITS = risk_limits(P, RiskParameters())
STILL = np.zeros(2)
NOTHING = np.zeros((0, 2)), np.zeros(0)


@pytest.fixture
def world(view):
    """A local map and the density on it, after a look for some frames; then unseen."""

    def make(pan=0.0, frames=3, pose=(0.0, 0.0, 0.0), parameters=P):
        local_map = LocalMap(LocalMapParameters(), pose[:2], 0.0)
        undetected = Undetected.unseen(parameters, local_map, 0.0)
        viewpoint = Viewpoint.of(view(pan, -0.6), np.array(pose), 2.5)
        for k in range(frames):
            time = 0.06 * (k + 1)
            local_map.update(time, viewpoint, pose[:2], *NOTHING)
            undetected = undetected.updated(local_map, time)
        return local_map, undetected

    return make


def risks(undetected, velocity=STILL, position=STILL):
    return undetected.risks(np.array(position), np.array(velocity), LIMITS)


def test_ground_in_view_loses_its_risk_and_ground_beside_keeps_it(world):
    cells = risks(world(frames=4)[1])
    ahead = np.abs(np.arctan2(cells[:, 1], cells[:, 0])) < 0.5
    behind = np.abs(np.arctan2(cells[:, 1], cells[:, 0])) > 2.0
    assert cells[behind, 2].sum() > 50.0 * cells[ahead, 2].sum()


def test_undetected_movers_enter_ground_that_was_seen_before(world, view):
    local_map, undetected = world(frames=4)
    before = risks(undetected)
    blind = Viewpoint.of(replace(view(), blind=True), np.zeros(3), 2.5)
    for k in range(150):
        local_map.update(0.3 + 0.06 * k, blind, (0.0, 0.0), *NOTHING)
        undetected = undetected.updated(local_map, 0.3 + 0.06 * k)
    after = risks(undetected)

    def ahead(cells):
        return cells[np.abs(np.arctan2(cells[:, 1], cells[:, 0])) < 0.4, 2].sum()

    assert ahead(after) > 5.0 * ahead(before)
    assert after[:, 2].sum() <= risks(world(frames=0)[1])[:, 2].sum() + 1e-9


def test_static_obstacles_are_a_risk_on_the_path_only(world):
    static = replace(P, movers=0.0)
    cells = risks(world(frames=0, parameters=static)[1], velocity=(0.2, 0.0))
    assert cells[:, 0].min() > 0.0
    assert np.abs(cells[:, 1]).max() < P.gap + 0.1
    assert len(risks(world(frames=0, parameters=static)[1])) == 0


def test_the_densities_stay_in_the_world_while_the_map_scrolls(world, view):
    local_map, undetected = world(frames=4, parameters=replace(P, speed=1e-9))
    before = risks(undetected)
    blind = Viewpoint.of(replace(view(), blind=True), np.zeros(3), 2.5)
    local_map.update(0.3, blind, (0.6, -0.3), *NOTHING)
    undetected = undetected.updated(local_map, 0.3)
    after = risks(undetected, position=(0.0, 0.0))
    assert after == pytest.approx(before)
