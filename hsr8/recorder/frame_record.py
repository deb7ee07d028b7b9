"""What one camera frame led to; of the true world it knows nothing."""

import numpy as np
from numpy.typing import NDArray

from hsr8.decisions import Decided, Now
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision, MotionDecision, Task
from navigation.observation import Frame
from vision.detection import Detection
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
