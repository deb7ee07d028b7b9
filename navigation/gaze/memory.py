"""Memory of the gaze: all that lives from frame to frame."""

from compilation.value import value
from navigation.decision import GazeDecision
from navigation.parameters.gaze import GazeParameters


@value
class Fixation:
    """Latest decision of the gaze, with the times of saccade and dwell.

    Attributes:
        decision: chosen gaze.
        direction: direction of its pan in W [rad].
        decided: time of the decision [s].
        arrived: time at which the camera arrived; None during the saccade [s].
    """

    decision: GazeDecision
    direction: float
    decided: float
    arrived: float | None = None

    def observed(self, time: float, error: float, parameters: GazeParameters) -> "Fixation":
        """Return the fixation at `time` [s] with the camera `error` [rad] from its target."""
        if self.arrived is not None or error > parameters.arrival_tolerance:
            return self
        return Fixation(self.decision, self.direction, self.decided, time)

    def is_over(self, time: float, parameters: GazeParameters) -> bool:
        """Return whether to decide at `time` [s]: after the dwell, or if the saccade takes long."""
        p = parameters
        dwelled = self.arrived is not None and time - self.arrived >= p.dwell - 1e-9
        longest = p.max_saccade_time if p.moved_by == "head" else p.max_turn_time
        return dwelled or time - self.decided >= longest

    def is_kept_by(self, decision: GazeDecision, direction: float, held: bool) -> bool:
        """Return whether a new decision has the same target, which is `held` in W or in R."""
        same = direction == self.direction if held else decision.pan == self.decision.pan
        return same and decision.tilt == self.decision.tilt


@value
class GazeMemory:
    """State of the gaze between two frames.

    Attributes:
        fixation: latest decision; None before the first.
        policy: memory of the policy.
        search: memory of the policy of a lost robot.
    """

    fixation: Fixation | None
    policy: object
    search: object
