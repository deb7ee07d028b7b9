"""Record of a camera frame: detections, belief and decisions, without ground truth."""

import numpy as np
from numpy.typing import NDArray

from hsr8.decisions import Decision, DecisionContext
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision, MotionDecision, Task
from navigation.observation import Frame
from vision.detection import Detection
from walking.signals import value

Image = NDArray[np.uint8]


@value
class FrameRecord:
    """Detections, belief and decisions of one camera frame.

    Attributes:
        index: number of the frame.
        time: time at which the frame reached the robot [s].
        image: (height, width, 3) RGB, or None with the analytic camera.
        detections: detections of vision in the image.
        measured: input of the estimator at capture, which is earlier by the latency.
        estimate: belief at capture.
        context: input of the decisions.
        decision: belief at `time`, task, motion and gaze.
    """

    index: int
    time: float
    image: Image | None
    detections: tuple[Detection, ...]
    measured: Frame
    estimate: Belief
    context: DecisionContext
    decision: Decision

    @property
    def belief(self) -> Belief:
        """Belief at `time`."""
        return self.decision.belief

    @property
    def gaze(self) -> GazeDecision:
        """Gaze decision."""
        return self.decision.gaze

    @property
    def motion(self) -> MotionDecision:
        """Motion decision, new once per footstep."""
        return self.decision.motion

    @property
    def task(self) -> Task:
        """Current task of the mission."""
        return self.decision.task
