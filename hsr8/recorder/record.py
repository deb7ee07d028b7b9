"""Records that the loop publishes, and the interface of listeners."""

from typing import Protocol

from hsr8.recorder.frame_record import FrameRecord
from hsr8.recorder.walk_counters import WalkCounters
from hsr8.world.truth.truth import Truth
from walking.command import Command, HeadTarget
from walking.state import WalkingState
from walking.value import value


@value
class TickRecord:
    """State of the run, published once per record period (20 ms by default).

    Attributes:
        tick: number of the control tick.
        time: simulated time [s].
        truth: state of the world.
        walking: state of the walking engine.
        counters: counters of all ticks since the start; the object is updated further.
        command: commanded velocity or footsteps.
        head: commanded gaze.
        frame: camera frame that arrived since the last record, if any.
    """

    tick: int
    time: float
    truth: Truth
    walking: WalkingState
    counters: WalkCounters
    command: Command
    head: HeadTarget
    frame: FrameRecord | None


class Listener(Protocol):
    """Observer of a run; it never changes the run. Methods do nothing by default."""

    def on_record(self, record: TickRecord) -> None:
        """Receive one record."""
        return

    def on_event(self, time: float, kind: str, text: str) -> None:
        """Receive one event, for example ``via_point``, ``collision``, ``fall``."""
        return

    def close(self, exit_reason: str) -> None:
        """End the observation; called once, also after an error."""
        return
