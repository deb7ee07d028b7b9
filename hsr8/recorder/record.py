"""What the loop publishes and who may listen."""

from typing import Protocol

from hsr8.recorder.frame_record import FrameRecord
from hsr8.recorder.walk_counters import WalkCounters
from hsr8.world.truth.truth import Truth
from walking.command import Command, HeadTarget
from walking.state import WalkingState
from walking.value import value


@value
class TickRecord:
    """Published once per record period (20 ms by default).

    Attributes:
        tick: number of the control tick.
        time: simulated time [s].
        truth: state of the world.
        walking: what the walking engine knows of itself.
        counters: what was counted in every tick since the start; it counts on.
        command: velocity or footsteps asked of it.
        head: gaze asked of it.
        frame: the camera frame that arrived since the last record, if any.
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
