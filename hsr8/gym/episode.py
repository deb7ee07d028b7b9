"""One run of an environment: the simulation, and the tables for its metrics in memory."""

from contextlib import ExitStack
from time import perf_counter
from typing import Any

from hsr8.decisions import Situation
from hsr8.evaluation import metrics
from hsr8.loop import Simulation
from hsr8.recorder.memory import Memory
from hsr8.recorder.recorder import Recorder
from hsr8.scenario.schema import Scenario
from hsr8.world.truth.truth import Truth

FAILURES = ("contact", "fall", "diverged")


class Episode:
    """Run that stops at the decisions of an environment; close it.

    Args:
        scenario: to run.
        seed: of the run.
        footsteps: stop at the decisions of motion only, not at every frame.
        end_on_contact: end at the first contact with an obstacle.

    Attributes:
        simulation: of the run.
        exit_reason: that of the simulation or contact; empty before the end.
    """

    def __init__(
        self, scenario: Scenario, seed: int, *, footsteps: bool, end_on_contact: bool
    ) -> None:
        self._started = perf_counter()
        self._footsteps = footsteps
        self._end_on_contact = end_on_contact
        self.simulation = Simulation(scenario, seed)
        self.exit_reason = ""
        self._situation: Situation | None = None
        self._memory = Memory(metrics.COLUMNS)
        joints, scale = self.simulation.humanoid.model.names, self.simulation.layout.scale
        self._recorder = Recorder(joints, [self._memory], scale=scale)
        self._open = ExitStack()
        self._open.enter_context(self.simulation)

    @property
    def truth(self) -> Truth:
        """Ground truth of the latest record."""
        assert self.simulation.truth is not None
        return self.simulation.truth

    @property
    def situation(self) -> Situation:
        """Latest situation that the robot decides in."""
        assert self._situation is not None
        return self._situation

    def advance(self) -> bool:
        """Run to the next decision; return False at the end of the run."""
        while not self.exit_reason:
            situation = self.simulation.perceive()
            self._situation = situation or self._situation
            if self._end_on_contact and self.truth.contacts:
                self.complete()
                self.exit_reason = "contact"
            elif situation is not None and (situation.motion_due or not self._footsteps):
                return True
            else:
                self.complete()
        return False

    def complete(self) -> None:
        """Complete the tick with the decisions made."""
        self._recorder.append(self.simulation.step())
        self.exit_reason = self.simulation.exit_reason or ""

    def results(self) -> dict[str, Any]:
        """Return the metrics of the run, after its end."""
        self._recorder.close(self.exit_reason)
        simulation = self.simulation
        return metrics.metrics(
            self._memory.tables(),
            simulation.layout,
            simulation.scenario.navigation.mission,
            certificate=simulation.certificate,
            exit_reason=self.exit_reason,
            state_hash=simulation.state_hash(),
            wall_time=perf_counter() - self._started,
        )

    def close(self) -> None:
        """Close the simulation."""
        self._open.close()
