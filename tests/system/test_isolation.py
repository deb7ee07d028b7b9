"""The robot side never reads the truth: the run is the same when access raises."""

import pytest

from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.body.physics import PhysicsBody

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
    ("kind", "parts"),
    [
        (KinematicBody, ['robot.body="kinematic"', 'camera.source="analytic"']),
        pytest.param(
            PhysicsBody, ['robot.body="full"', 'camera.source="rendered"'], marks=pytest.mark.gl
        ),
    ],
)
def test_the_loop_runs_the_same_without_the_truth(monkeypatch, kind, parts):
    scenario = load_scenario("quick", [*parts, "duration=2.0"])
    expected = Simulation(scenario, 0).run()
    truth = kind.truth
    monkeypatch.setattr(kind, "truth", lambda body: Forbidden(truth(body)))
    assert Simulation(scenario, 0).run() == expected
