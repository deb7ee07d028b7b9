"""What happens in a run, as events: faults, contacts, falls, pushes, via points, the goal."""

from collections.abc import Callable, Sequence

from hsr8.recorder.record import FrameRecord
from hsr8.scenario.fault import Fault
from hsr8.world.episodes import Episodes
from hsr8.world.falls import Falls
from hsr8.world.truth import Truth

INSTANT = 1e-6  # times nearer to one another are the same [s]


class EventWatch:
    """Turns records into events.

    Args:
        tell: takes kind, text, and the time where it is not now [s].
        faults: of the scenario.
    """

    def __init__(self, tell: Callable[..., None], faults: Sequence[Fault] = ()) -> None:
        self._tell = tell
        told = [(f.start, f"{f.text()}: begins") for f in faults]
        told += [(f.end, f"{f.text()}: ends") for f in faults if f.end is not None]
        self._faults = sorted(told, key=lambda line: line[0])
        self._pushes = 0
        self._episodes = Episodes()
        self._falls = Falls()
        self._index = 0
        self._lost = False
        self._done = False

    def look(self, truth: Truth, frame: FrameRecord | None) -> None:
        """Tell what changed since the last record."""
        while self._faults and self._faults[0][0] <= truth.time + INSTANT:
            time, text = self._faults.pop(0)
            self._tell("fault", text, time)
        for push in truth.pushes:
            if push.number >= self._pushes:
                self._pushes = push.number + 1
                self._tell("push", push.text(), push.begin)
        if self._falls.add(truth.time, fallen=truth.fallen):
            self._tell("fall", "the robot has fallen")
        for collision in self._episodes.add(truth.time, truth.contacts):
            what = "mover" if collision.moving else "obstacle"
            self._tell("collision", f"{collision.robot_geom} touches {what} {collision.obstacle}")
        if frame is None:
            return
        if frame.task.index > self._index:
            self._index = frame.task.index
            self._tell("via_point", f"via point {self._index} passed")
        if frame.task.done and not self._done:
            self._done = True
            self._tell("goal", "goal reached")
        if frame.belief.lost != self._lost:
            self._lost = frame.belief.lost
            self._tell(
                *(("lost", "localization is lost") if self._lost else ("found", "localized again"))
            )
