"""The robot side never reads the truth: the run is the same when access raises."""

import dataclasses

import numpy as np
import pytest

from hsr8.loop import Simulation
from hsr8.scenario.loader import load_scenario
from hsr8.world.truth.truth import Truth

REFEREE = {
    "fallen",
    "contacts",
    "pushes",
    "time",
}  # read by the loop for the end and the events of a run


class Forbidden:
    """Truth that raises on access to all but the attributes of `REFEREE`."""

    def __init__(self, truth):
        self._truth = truth

    def __getattr__(self, name):
        if name in REFEREE:
            return getattr(self._truth, name)
        raise AssertionError(f"the loop read truth.{name}")


@pytest.mark.parametrize(
    "parts",
    [
        ['robot.body="kinematic"', 'camera.source="analytic"'],
        pytest.param(['robot.body="full"', 'camera.source="rendered"'], marks=pytest.mark.gl),
    ],
)
def test_the_loop_runs_the_same_without_the_truth(monkeypatch, parts):
    scenario = load_scenario("quick", [*parts, "duration=2.0"])
    expected = Simulation(scenario, 0).run()
    blind = Simulation(scenario, 0)
    body = blind._body
    truth = body.truth
    monkeypatch.setattr(body, "truth", lambda: Forbidden(truth()))
    assert blind.run() == expected


def test_the_stand_in_really_forbids():
    blank = {f.name: np.zeros(1) for f in dataclasses.fields(Truth)}
    forbidden = Forbidden(Truth(**blank))
    for name in blank.keys() - REFEREE:
        try:
            getattr(forbidden, name)
        except AssertionError:
            continue
        raise RuntimeError(f"{name} can be read")
