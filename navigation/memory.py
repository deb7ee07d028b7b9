"""Memory of the decisions: all that lives from frame to frame.

A relocalization or a fall replaces it by the memory of the start: directions, sides and densities
of the former pose are wrong.
"""

from compilation.value import value


@value
class Memory:
    """State of the decisions between two frames.

    Attributes:
        motion: state of the motion planner.
        gaze: state of the gaze.
        lost: whether the robot was lost in the latest frame.
    """

    motion: object
    gaze: object
    lost: bool = False
