"""What the loop publishes and who may listen."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hsr8.decisions import Decided, Now
from hsr8.recorder.walk_tally import WalkTally
from hsr8.world.truth.truth import Truth
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision, MotionDecision, Task
from navigation.observation import Frame
from vision.detection import Detection
from walking.command import Command, HeadTarget
from walking.state import WalkingState
from walking.value import value

Image = NDArray[np.uint8]


@value
class FrameRecord:
    """What one camera frame led to.

    Attributes:
        index: number of the frame.
        time: when it reached the robot [s].
        image: (height, width, 3) RGB, or None with the analytic camera.
        detections: what vision found in it.
        measured: all that reached the belief, at the capture; earlier by the latency.
        estimate: what is believed of that time.
        now: the moment it was decided for.
        decided: what the robot believes at `time`, and what it decided.
    """

    index: int
    time: float
    image: Image | None
    detections: tuple[Detection, ...]
    measured: Frame
    estimate: Belief
    now: Now
    decided: Decided

    @property
    def belief(self) -> Belief:
        """What the robot believes at `time`."""
        return self.decided.belief

    @property
    def gaze(self) -> GazeDecision:
        """Where it decided to look."""
        return self.decided.gaze

    @property
    def motion(self) -> MotionDecision:
        """How it decided to move (the decision in force; new once per footstep)."""
        return self.decided.motion

    @property
    def task(self) -> Task:
        """Where it is going."""
        return self.decided.task


@value
class TickRecord:
    """Published once per record period (20 ms by default).

    Attributes:
        tick: number of the control tick.
        time: simulated time [s].
        truth: state of the world.
        walking: what the walking engine knows of itself.
        tally: what was counted in every tick since the start; it counts on.
        command: velocity or footsteps asked of it.
        head: gaze asked of it.
        frame: the camera frame that arrived since the last record, if any.
    """

    tick: int
    time: float
    truth: Truth
    walking: WalkingState
    tally: WalkTally
    command: Command
    head: HeadTarget
    frame: FrameRecord | None


class Listener(Protocol):
    """Somebody who watches a run; watching never changes it.

    What a class derived from it leaves out does nothing.
    """

    def on_record(self, record: TickRecord) -> None:
        """Take one record."""
        return

    def on_event(self, time: float, kind: str, text: str) -> None:
        """Take one event, for example ``via_point``, ``collision``, ``fall``."""
        return

    def close(self, exit_reason: str) -> None:
        """The run has ended, for whatever reason."""
        return
