"""One run of an environment, recorded in memory."""

from contextlib import ExitStack

from hsr8.driver import Recording
from hsr8.recording.manifest import CALL
from hsr8.recording.run import Run
from hsr8.recording.run_folder import RunFolder
from hsr8.scenario.schema import Scenario
from hsr8.simulation.decisions import Situation
from hsr8.simulation.loop import Simulation
from hsr8.world.truth.truth import Truth

FAILURES = ("contact", "fall", "diverged")


class Episode:
    """Run that stops at the decisions of an environment; close it.

    Args:
        scenario: scenario to run.
        seed: seed of the run.
        footsteps: stop at the decisions of motion only, not at every frame.
        end_on_contact: end at the first contact with an obstacle.

    Attributes:
        simulation: simulation of the run.
        exit_reason: reason of the simulation, or contact; empty before the end.
    """

    def __init__(
        self, scenario: Scenario, seed: int, *, footsteps: bool, end_on_contact: bool
    ) -> None:
        self._footsteps = footsteps
        self._end_on_contact = end_on_contact
        self.simulation = Simulation(scenario, seed)
        self.exit_reason = ""
        self._situation: Situation | None = None
        folder = RunFolder(None, self.simulation.scenario, (f"{CALL}...)",), scenario.camera.source)
        self._recording = Recording(self.simulation, folder)
        self._open = ExitStack()
        self._open.enter_context(self._recording)

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
        self._recording.append(self.simulation.step())
        self.exit_reason = self.simulation.exit_reason or ""

    def run(self) -> Run:
        """End the run and return it."""
        self._recording.exit_reason = self.exit_reason
        self.close()
        return self._recording.run()

    def close(self) -> None:
        """Close the simulation."""
        self._open.close()
